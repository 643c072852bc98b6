#include "railtab/contact.h"

#include <fmt/format.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstring>
#include <exception>
#include <memory>
#include <new>
#include <optional>
#include <string_view>
#include <utility>
#include <variant>

#include "railtab/runtime/base/input_error.hpp"
#include "railtab/runtime/base/version.hpp"
#include "railtab/runtime/contact/contact_response.hpp"
#include "railtab/runtime/contact/frictionless_contact.hpp"
#include "railtab/runtime/contact_files/contact_table_file.hpp"
#include "railtab/runtime/contact_files/creep_law_file.hpp"

struct railtab_contact {
  railtab::ContactTable table;
  railtab::WheelContactModel model;  ///< of the table's geometry
};

namespace railtab {
namespace {

/// The buffer of a caller that gets a message; empty until one is set.
class Message {
 public:
  Message(char* text, std::size_t size) noexcept : text_(text), size_(text ? size : 0) { set({}); }
  void set(std::string_view words) noexcept {
    if (size_ == 0) return;
    std::size_t length = std::min(words.size(), size_ - 1);
    // a character of several bytes is cut as a whole
    while (length < words.size() && length > 0 && (words[length] & 0xC0) == 0x80) --length;
    std::copy_n(words.begin(), length, text_);
    text_[length] = '\0';
  }

 private:
  char* text_;
  std::size_t size_;
};

/// The status of `work`, or of the exception that leaves it.
template <typename Work>
railtab_status guarded(Message message, const Work& work) noexcept {
  try {
    return work();
  } catch (const InputError& wrong) {
    message.set(wrong.what());
    return RAILTAB_INVALID_INPUT;
  } catch (const std::bad_alloc&) {
    message.set(railtab_status_text(RAILTAB_OUT_OF_MEMORY));
    return RAILTAB_OUT_OF_MEMORY;
  } catch (const std::exception& failure) {
    message.set(failure.what());
    return RAILTAB_INTERNAL_ERROR;
  } catch (...) {
    message.set(railtab_status_text(RAILTAB_INTERNAL_ERROR));
    return RAILTAB_INTERNAL_ERROR;
  }
}

template <typename Work>
railtab_status guarded(const Work& work) noexcept {
  return guarded(Message(nullptr, 0), work);
}

InputError parameter_error(std::string_view name, std::string_view found, std::string_view expected) {
  return input_error(fmt::format("contact parameters: {}", name), found, expected);
}

void require_range(const char* name, double value, double low, double high) {
  if (value >= low && value <= high) return;
  throw parameter_error(name, fmt::format("{}", value), fmt::format("{} to {}", low, high));
}

bool moves(double speed, double speed_floor) noexcept {
  return std::isfinite(speed) && speed >= 0.0 && std::max(speed, speed_floor) > 0.0;
}

/// @throws InputError naming the first parameter out of its range
void require_valid(const railtab_contact_parameters& p) {
  if (!(std::isfinite(p.speed_floor) && p.speed_floor >= 0.0)) {
    throw parameter_error("speed_floor", fmt::format("{} m/s", p.speed_floor), "0 m/s or more");
  }
  if (!moves(p.speed, p.speed_floor)) {
    throw parameter_error("speed", fmt::format("{} m/s", p.speed), "above 0 m/s, or 0 with a speed_floor above 0");
  }
  require_range("friction", p.friction, 0.0, 2.0);
  require_range("friction_limit", p.friction_limit, 0.0, 1.0);
  require_range("friction_decay", p.friction_decay, 0.0, 1e3);
  require_range("initial_slope", p.initial_slope, 1e-3, 1.0);
  require_range("damping", p.damping, 0.0, 1e3);
  require_range("curvature_floor", p.curvature_floor, 1e-6, 1e4);
  require_range("k_adhesion", p.k_adhesion, 1e-3, 1.0);
  require_range("k_slip", p.k_slip, 1e-3, p.k_adhesion);
  ElasticMaterial{p.young, p.poisson}.validate();
}

std::string_view name_of(int law) {
  switch (law) {
    case RAILTAB_CREEP_TABLE:
      return "table";
    case RAILTAB_CREEP_POLACH:
      return "polach";
    case RAILTAB_CREEP_FASTSIM:
      return "fastsim";
    case RAILTAB_CREEP_LINEAR:
      return "linear";
    default:
      throw parameter_error("creep_law", fmt::format("{}", law), "a railtab_creep_law, 0 to 3");
  }
}

CreepLaw law_of(const railtab_contact_parameters& p, const char* creep_table) {
  const std::string_view name = name_of(p.creep_law);
  if (creep_table && p.creep_law != RAILTAB_CREEP_TABLE) {
    throw input_error("creep_table", fmt::format("{} with the creep law {}", creep_table, name),
                      "NULL, or the creep law RAILTAB_CREEP_TABLE");
  }
  CreepLaw law = creep_law(name, p.poisson, creep_table ? creep_table : "");
  if (auto* const polach = std::get_if<PolachCreep>(&law)) {
    polach->k_adhesion = p.k_adhesion;
    polach->k_slip = p.k_slip;
  }
  return law;
}

std::unique_ptr<railtab_contact> opened(const char* geometry_table, const char* creep_table,
                                        const railtab_contact_parameters& p) {
  require_valid(p);
  WheelContactModel model;
  model.normal.material = {p.young, p.poisson};
  model.normal.curvature_floor = p.curvature_floor;
  model.creep_law = law_of(p, creep_table);
  model.friction = p.friction;
  model.friction_law = {p.friction_limit, p.friction_decay, p.initial_slope};
  model.damping = p.damping;
  model.speed = p.speed;
  model.speed_floor = p.speed_floor;
  ContactTable table = read_contact_table(geometry_table);
  if (const LoadedTable* const loaded = table.geometry.loaded()) {
    const double modulus = loaded->data().contact_modulus;
    if (!model.normal.material.has_contact_modulus(modulus)) {
      throw parameter_error(
          "young, poisson",
          fmt::format("steel of the contact modulus E* = {:.6g} Pa", model.normal.material.contact_modulus()),
          fmt::format("{:.6g} Pa, that of the loaded part of {}", modulus, geometry_table));
    }
  }
  auto contact = std::make_unique<railtab_contact>(railtab_contact{std::move(table), std::move(model)});
  contact->model.geometry = &contact->table.geometry;
  return contact;
}

/// What a call asks about: a wheel, and how it and the rail move.
struct Query {
  WheelSide side;
  WheelsetMotion wheelset;
  RailHeadMotion rail;
};

std::optional<WheelSide> known_side(int side) noexcept {
  switch (side) {
    case RAILTAB_LEFT:
      return WheelSide::left;
    case RAILTAB_RIGHT:
      return WheelSide::right;
    default:
      return std::nullopt;
  }
}

bool is_valid(const RailHeadMotion& rail) noexcept {
  return rail.displacement.allFinite() && rail.velocity.allFinite() && std::isfinite(rail.yaw) &&
         std::isfinite(rail.slope) && std::isfinite(rail.friction) && rail.friction >= 0.0;
}

/// Nothing where the input is invalid.
std::optional<Query> query_of(int side, const railtab_wheelset_motion* wheelset,
                              const railtab_rail_motion* rail) noexcept {
  const std::optional<WheelSide> of_side = known_side(side);
  if (!of_side || !wheelset) return std::nullopt;
  Query query{
      *of_side, {Eigen::Map<const Vector6>(wheelset->displacement), Eigen::Map<const Vector6>(wheelset->velocity)}, {}};
  if (rail) {
    query.rail = {Eigen::Map<const Vector3>(rail->displacement), Eigen::Map<const Vector3>(rail->velocity), rail->yaw,
                  rail->slope, rail->friction};
  }
  if (!query.wheelset.displacement.allFinite() || !query.wheelset.velocity.allFinite() || !is_valid(query.rail)) {
    return std::nullopt;
  }
  return query;
}

WheelsetPose pose_of(const railtab_contact& contact, const Query& query) noexcept {
  return relative_pose(contact.table.geometry.pair(), query.side, query.wheelset, query.rail);
}

railtab_status status_of(const WheelContact& contact) noexcept {
  return contact.by_patches() && !contact.patches.from_table ? RAILTAB_SEARCHED : RAILTAB_OK;
}

void put_force(const WheelContact& at, const WheelForce& force, railtab_wheel_force& result) noexcept {
  Eigen::Map<Vector6>(result.wheelset) = force.wheelset;
  Eigen::Map<Vector3>(result.rail) = force.rail;
  result.rail_x = force.rail_x;
  result.touches = at.touches() ? 1 : 0;
  result.outside_creep_table = force.outside_creep_table;
}

railtab_patch patch_of(const ContactPatch& p, const PatchLoading& load) noexcept {
  railtab_patch result;
  result.y_rail = p.y_rail;
  result.z_rail = p.z_rail;
  result.y_wheel = p.y_wheel;
  result.z_wheel = p.z_wheel;
  result.x = p.x;
  result.angle = p.angle;
  result.rolling_radius = p.rolling_radius;
  result.penetration = std::max(0.0, p.penetration);
  result.curvature_wheel = p.curv_wheel;
  result.curvature_rail = p.curv_rail;
  result.normal_force = load.normal_force;
  result.a = load.a;
  result.b = load.b;
  result.pressure = load.pressure;
  result.concave = p.concave ? 1 : 0;
  return result;
}

}  // namespace
}  // namespace railtab

extern "C" {

const char* railtab_status_text(int status) {
  switch (status) {
    case RAILTAB_OK:
      return "no error";
    case RAILTAB_SEARCHED:
      return "no error; the online search answered outside the geometry table";
    case RAILTAB_INVALID_INPUT:
      return "invalid input: a null pointer, a number out of its range, or a file that is no table";
    case RAILTAB_OUT_OF_MEMORY:
      return "out of memory";
    case RAILTAB_INTERNAL_ERROR:
      return "internal error of railtab";
    default:
      return "unknown status";
  }
}

const char* railtab_version(void) { return railtab::version(); }

railtab_status railtab_contact_default_parameters(railtab_contact_parameters* parameters) {
  if (!parameters) return RAILTAB_INVALID_INPUT;
  const railtab::WheelContactModel model;
  const railtab::PolachCreep polach;
  parameters->speed = 0.0;
  parameters->speed_floor = model.speed_floor;
  parameters->friction = model.friction;
  parameters->friction_limit = model.friction_law.limit;
  parameters->friction_decay = model.friction_law.decay;
  parameters->initial_slope = model.friction_law.initial_slope;
  parameters->damping = model.damping;
  parameters->young = model.normal.material.E;
  parameters->poisson = model.normal.material.nu;
  parameters->curvature_floor = model.normal.curvature_floor;
  parameters->k_adhesion = polach.k_adhesion;
  parameters->k_slip = polach.k_slip;
  parameters->creep_law = RAILTAB_CREEP_TABLE;
  return RAILTAB_OK;
}

railtab_status railtab_contact_open(const char* geometry_table, const char* creep_table,
                                    const railtab_contact_parameters* parameters, railtab_contact** contact,
                                    char* message, size_t message_size) {
  if (contact) *contact = nullptr;
  return railtab::guarded(railtab::Message(message, message_size), [&] {
    if (!geometry_table || !parameters || !contact) {
      throw railtab::input_error("railtab_contact_open", "a null pointer",
                                 "a geometry table, parameters and a place for the contact");
    }
    *contact = railtab::opened(geometry_table, creep_table, *parameters).release();
    return RAILTAB_OK;
  });
}

void railtab_contact_close(railtab_contact* contact) { delete contact; }

railtab_status railtab_contact_set_speed(railtab_contact* contact, double speed) {
  if (!contact || !railtab::moves(speed, contact->model.speed_floor)) return RAILTAB_INVALID_INPUT;
  contact->model.speed = speed;
  return RAILTAB_OK;
}

railtab_status railtab_contact_dimensions(const railtab_contact* contact, railtab_dimensions* dimensions) {
  if (!contact || !dimensions) return RAILTAB_INVALID_INPUT;
  const railtab::WheelRailPair& pair = contact->table.geometry.pair();
  const railtab::PairDimensions& of = pair.dimensions();
  *dimensions = {of.track_gauge,    of.gauge_height,           of.flange_back,
                 of.nominal_radius, pair.tape_circle_offset(), pair.rail_offset()};
  return RAILTAB_OK;
}

railtab_status railtab_contact_force(const railtab_contact* contact, int side, const railtab_wheelset_motion* wheelset,
                                     const railtab_rail_motion* rail, railtab_wheel_force* force) {
  return railtab::guarded([&] {
    const auto query = railtab::query_of(side, wheelset, rail);
    if (!contact || !query || !force) return RAILTAB_INVALID_INPUT;
    const railtab::WheelContact at = railtab::wheel_contact(contact->table.geometry, pose_of(*contact, *query));
    railtab::put_force(at, wheel_force(contact->model, query->side, query->wheelset, query->rail, at), *force);
    return railtab::status_of(at);
  });
}

railtab_status railtab_contact_force_and_tangent(const railtab_contact* contact, int side,
                                                 const railtab_wheelset_motion* wheelset,
                                                 const railtab_rail_motion* rail, double velocity_rate,
                                                 railtab_wheel_force* force, double* tangent) {
  return railtab::guarded([&] {
    const auto query = railtab::query_of(side, wheelset, rail);
    if (!contact || !query || !force || !tangent || !std::isfinite(velocity_rate)) return RAILTAB_INVALID_INPUT;
    const railtab::StepRates rates{railtab::Vector6::Constant(velocity_rate), velocity_rate};
    const railtab::WheelResponse response =
        railtab::wheel_response(contact->model, query->side, query->wheelset, query->rail, rates);
    railtab::put_force(response.contact, response.force, *force);
    Eigen::Map<Eigen::Matrix<double, 9, 9, Eigen::RowMajor>> rows(tangent);
    rows = response.tangent;
    return railtab::status_of(response.contact);
  });
}

railtab_status railtab_contact_patches(const railtab_contact* contact, int side,
                                       const railtab_wheelset_motion* wheelset, const railtab_rail_motion* rail,
                                       railtab_patch* patches, int* count) {
  static_assert(RAILTAB_MAX_PATCHES == railtab::ContactPatches::capacity);
  return railtab::guarded([&] {
    const auto query = railtab::query_of(side, wheelset, rail);
    if (!contact || !query || !patches || !count) return RAILTAB_INVALID_INPUT;
    const railtab::WheelsetPose pose = pose_of(*contact, *query);
    const railtab::ContactPatches found = contact->table.patches.patches(pose, railtab::touch_rounding);
    const auto loads = patch_loadings(contact->table.geometry, pose, found, contact->model.normal);
    for (int i = 0; i < found.count; ++i) {
      const auto at = static_cast<std::size_t>(i);
      patches[i] = railtab::patch_of(found.patch[at], loads[at]);
    }
    *count = found.count;
    return found.from_table ? RAILTAB_OK : RAILTAB_SEARCHED;
  });
}

railtab_status railtab_contact_height(const railtab_contact* contact, int side, double y, double roll, double yaw,
                                      double load, double* z) {
  return railtab::guarded([&] {
    const auto of_side = railtab::known_side(side);
    if (!contact || !of_side || !z || !std::isfinite(y) || !std::isfinite(roll) || !std::isfinite(yaw)) {
      return RAILTAB_INVALID_INPUT;
    }
    const railtab::WheelsetPose right{y, 0.0, roll, yaw};
    const railtab::WheelsetPose pose = *of_side == railtab::WheelSide::right ? right : right.mirrored();
    *z = lowered_pose(contact->table.patches.search(), contact->table.geometry, pose, railtab::Lowering::under_load,
                      load, contact->model.normal, [] { return "railtab_contact_height"; })
             .pose.z;
    return RAILTAB_OK;
  });
}

}  // extern "C"
