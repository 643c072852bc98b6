#include "railtab/runtime/scene/scene_parameters.hpp"

#include <fmt/format.h>

#include "railtab/tables/input_error.hpp"

namespace railtab {
namespace {

/// `ok` is false for NaN in every use below.
void require(bool ok, std::string_view key, double found, std::string_view expected) {
  if (!ok) throw input_error(key, fmt::format("{}", found), expected);
}

}  // namespace

std::string_view contact_mode_name(const ContactParameters& contact) noexcept {
  if (contact.normal == NormalContact::rigid) return "rigid";
  return contact.mode == ContactMode::table ? "table" : contact.mode == ContactMode::online ? "online" : "paper";
}

void IntegrationParameters::validate() const {
  require(time_step > 0.0 && time_step <= 0.1, "integration.time_step", time_step, "> 0, <= 0.1 s");
  require(duration >= 0.0, "integration.duration", duration, ">= 0 s");
  require(alpha >= -1.0 / 3.0 && alpha <= 0.0, "integration.alpha", alpha, "-1/3 to 0");
  require(tolerance > 0.0 && tolerance <= 1e-2, "integration.tolerance", tolerance, "> 0, <= 0.01");
  require(max_iterations >= 2, "integration.max_iterations", max_iterations, ">= 2");
  require(max_halvings >= 0, "integration.max_halvings", max_halvings, ">= 0");
}

void SceneParameters::validate() const {
  const std::string place = name.empty() ? "scene" : name;
  if (contact.normal == NormalContact::hertz && contact.mode == ContactMode::table && contact.table.empty()) {
    throw input_error(place, "contact.mode = \"table\" without contact.table",
                      "a geometry table (tablegen geometry makes one), or contact.mode = \"online\"");
  }
  if (!contact.creep_table.empty() && contact.creep_law != "table") {
    throw input_error(place, fmt::format("contact.creep_table with contact.creep_law = \"{}\"", contact.creep_law),
                      "contact.creep_law = \"table\", or no contact.creep_table");
  }
  if (track_kind != TrackKind::flexible && !spans.empty()) {
    throw input_error(
        place,
        fmt::format("a [[bridge]] on track.kind = \"{}\"", track_kind == TrackKind::rigid ? "rigid" : "imported"),
        "track.kind = \"flexible\" or no bridge");
  }
  const bool all_files =
      !structure.mass.empty() && !structure.damping.empty() && !structure.stiffness.empty() && !structure.dofs.empty();
  if (track_kind == TrackKind::imported && !all_files) {
    throw input_error(place, "track.kind = \"imported\" without all its files",
                      "structure.mass, structure.damping, structure.stiffness and structure.dofs");
  }
  if (train.count < 1) throw input_error(place, fmt::format("train.count = {}", train.count), ">= 1");
  require(train.speed > 0.0, "train.speed", train.speed, "> 0 m/s");
  integration.validate();
  reduction.validate();
  if (spectrum) spectrum->validate();
  if (reduction.kind == Reduction::modal && contact.normal == NormalContact::rigid) {
    throw input_error(place, "structure.reduction = \"modal\" with contact.normal = \"rigid\"",
                      "another reduction: wheels that follow the rails need their curvature, which few modes have not");
  }
  if (track_kind == TrackKind::flexible) {
    track.validate();
    for (const BridgeParameters& span : spans) span.validate();
  }
}

}  // namespace railtab
