#include "railtab/runtime/scene/shared_setup.hpp"

#include <fmt/format.h>

#include "railtab/runtime/base/file_checksum.hpp"
#include "railtab/runtime/base/text_file.hpp"
#include "railtab/runtime/scene/scene_contact.hpp"

namespace railtab {

namespace {

// Values of a study that each name a table of their own must not fill the memory.
constexpr std::size_t most_kept = 8;

std::string file_text(const std::filesystem::path& file) {
  if (file.empty() || !is_file(file)) return file.string();
  return fmt::format("{} {}", file.string(), file_checksum(file));
}

template <class Value, class Make>
Value kept(std::map<std::string, Value>& values, const std::string& key, const Make& make) {
  if (const auto found = values.find(key); found != values.end()) return found->second;
  if (values.size() >= most_kept) values.clear();
  return values.emplace(key, make()).first->second;
}

}  // namespace

std::shared_ptr<const ContactGeometry> SharedSetUp::geometry(const ContactParameters& contact,
                                                             const std::string& table_key) {
  const PairDimensions& d = contact.dimensions;
  const std::string key = fmt::format(
      "{} {} {} | {} | {} | {} | {} {} {} {} {} {}", static_cast<int>(contact.mode), static_cast<int>(contact.elastic),
      file_text(contact.table), file_text(contact.wheel), file_text(contact.rail), contact.rail_inclination,
      d.track_gauge, d.gauge_height, d.flange_back, d.nominal_radius, contact.material.E, contact.material.nu);
  return kept(geometry_, key,
              [&] { return std::make_shared<const ContactGeometry>(scene_geometry(contact, table_key)); });
}

CreepLaw SharedSetUp::creep_law(const ContactParameters& contact) {
  const std::string key =
      fmt::format("{} {} {}", contact.creep_law, contact.material.nu, file_text(contact.creep_table));
  return kept(creep_law_, key, [&] { return scene_creep_law(contact); });
}

SharedStructure SharedSetUp::structure(const SceneParameters& scene) {
  StructureKey key(scene);
  if (structure_key_ != key) {
    structure_key_.reset();  // also where the next line throws
    structure_ = share(scene_structure(scene));
    structure_key_ = std::move(key);
  }
  return structure_;
}

WindowModel SharedSetUp::window(const SharedStructure& structure, const ReductionParameters& reduction) {
  if (structure_of_window_ != structure) {
    window_ = make_window(*structure, reduction);
    structure_of_window_ = structure;
  }
  window_.ahead = reduction.ahead;
  window_.behind = reduction.behind;
  return window_;
}

}  // namespace railtab
