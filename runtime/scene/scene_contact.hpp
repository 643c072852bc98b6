#pragma once

#include <memory>
#include <string>
#include <vector>

#include "railtab/runtime/scene/scene_parameters.hpp"
#include "railtab/runtime/vsi/vsi_model.hpp"

namespace railtab {

class SharedSetUp;

/// Contact geometry of every wheelset and the laws of the contact forces, for a model whose vehicle and positions are
/// there already. [[profiles]] gives wheelsets other profiles than [contact]; the last entry that names a wheelset's
/// coach holds. @throws InputError where a table or profile is wrong, an entry meets no wheelset, wheels have another
/// radius than their profiles are for, or rails differ
/// @param shared what earlier runs have read; or null
void add_contact(const SceneParameters& scene, VsiModel& model, SharedSetUp* shared = nullptr);

/// Geometry of [contact]. @throws InputError
/// @param table_key the key that names the table, for messages
[[nodiscard]] ContactGeometry scene_geometry(const ContactParameters& contact,
                                             const std::string& table_key = "scene: contact.table");

/// Law of creep forces of [contact]. @throws InputError naming contact.creep_table where that is wrong
[[nodiscard]] CreepLaw scene_creep_law(const ContactParameters& contact);

/// Geometries of a model's wheelsets, each once, in the order in which they appear from the front of the train.
[[nodiscard]] std::vector<std::shared_ptr<const ContactGeometry>> contact_geometries(const VsiModel& model);

/// The coaches, counted from the front and from 1, whose wheelsets have a geometry: "1, 3 to 8".
[[nodiscard]] std::string coaches_on(const VsiModel& model, const ContactGeometry& geometry);

}  // namespace railtab
