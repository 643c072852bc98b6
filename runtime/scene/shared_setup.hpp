#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>

#include "railtab/runtime/scene/scene_parameters.hpp"
#include "railtab/runtime/scene/scene_structure.hpp"
#include "railtab/runtime/vsi/moving_window.hpp"
#include "railtab/runtime/vsi/structure_store.hpp"
#include "railtab/runtime/vsi/vsi_model.hpp"

namespace railtab {

/// What the runs of one process, one after the other, have in common and is made once: tables and profiles that were
/// read, the structure and its factors. Files that the scene names are read again where their contents have changed,
/// those that a mesh includes are not looked at.
class SharedSetUp {
 public:
  /// @throws InputError as reading the files
  [[nodiscard]] std::shared_ptr<const ContactGeometry> geometry(const ContactParameters& contact,
                                                                const std::string& table_key);
  [[nodiscard]] CreepLaw creep_law(const ContactParameters& contact);
  /// scene_structure(), of the last call where that was for the same structure.
  [[nodiscard]] SharedStructure structure(const SceneParameters& scene);
  /// make_window(), of the last call where that was for the same structure.
  [[nodiscard]] WindowModel window(const SharedStructure& structure, const ReductionParameters& reduction);
  [[nodiscard]] const std::shared_ptr<StructureStore>& structures() const noexcept { return structures_; }

 private:
  std::map<std::string, std::shared_ptr<const ContactGeometry>> geometry_;  // by all that it depends on
  std::map<std::string, CreepLaw> creep_law_;
  std::optional<StructureKey> structure_key_;
  SharedStructure structure_, structure_of_window_;
  WindowModel window_;
  std::shared_ptr<StructureStore> structures_ = std::make_shared<StructureStore>();
};

}  // namespace railtab
