#include "railtab/runtime/vehicle/consist.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <map>
#include <utility>

#include "railtab/runtime/base/input_error.hpp"
#include "railtab/runtime/vehicle/joint_file.hpp"
#include "railtab/runtime/vehicle/vehicle_library.hpp"

namespace railtab {

namespace {

// "side-frame", 1, "left" of "side-frame-1-left"; number 0: none.
struct NameParts {
  std::string stem, side;
  int number = 0;
};

NameParts parts_of(std::string_view name) {
  NameParts parts;
  for (const std::string_view side : {"-left", "-right"}) {
    if (!name.ends_with(side)) continue;
    parts.side = side;
    name.remove_suffix(side.size());
  }
  const std::size_t last = name.find_last_not_of("0123456789");
  if (last != name.npos && last + 1 < name.size() && last > 0 && name[last] == '-') {
    static_cast<void>(std::from_chars(name.data() + last + 1, name.data() + name.size(), parts.number));
    name = name.substr(0, last);
  }
  parts.stem = name;
  return parts;
}

// Names of the bodies as one who looks from the other end counts them.
std::vector<std::string> turned_names(const std::vector<RigidBody>& bodies) {
  std::map<std::string, int> count;
  for (const RigidBody& body : bodies) {
    const NameParts parts = parts_of(body.name);
    count[parts.stem] = std::max(count[parts.stem], parts.number);
  }
  std::vector<std::string> names;
  for (const RigidBody& body : bodies) {
    const NameParts parts = parts_of(body.name);
    const std::string number =
        parts.number > 0 ? fmt::format("-{}", count[parts.stem] + 1 - parts.number) : std::string();
    const std::string_view side = parts.side == "-left" ? "-right" : parts.side == "-right" ? "-left" : "";
    names.push_back(fmt::format("{}{}{}", parts.stem, number, side));
  }
  return names;
}

bool of_neighbour(const RigidBody& body) {
  return body.name.starts_with(of_vehicle_ahead) || body.name.starts_with(of_vehicle_behind);
}

// What a vehicle's file names behind the vehicle as it runs, and ahead of it.
const std::filesystem::path& joint_behind(const ConsistVehicle& v) {
  return v.reversed ? v.data.joint_front : v.data.joint_rear;
}
const std::filesystem::path& joint_ahead(const ConsistVehicle& v) {
  return v.reversed ? v.data.joint_rear : v.data.joint_front;
}

void add_joint(ConsistVehicle& ahead, const ConsistVehicle& behind, const std::filesystem::path& absent) {
  const std::filesystem::path &rear = joint_behind(ahead), &front = joint_ahead(behind);
  if (!rear.empty() && !front.empty() && rear != front) {
    throw input_error(ahead.data.place,
                      fmt::format("the joint {} where {} has {}", rear.string(), behind.data.place, front.string()),
                      "the same joint in the files of both neighbours, or in one of them");
  }
  const std::filesystem::path& file = !rear.empty() ? rear : !front.empty() ? front : absent;
  if (file.empty()) return;
  ahead.joint = read_joint_file(file);
  ahead.joint_reversed = !rear.empty() ? ahead.reversed : !front.empty() && behind.reversed;
}

// Collects bodies and force elements of a train.
class TrainParts {
 public:
  void add_vehicle(const ConsistVehicle& vehicle, double x, int coach) {
    const VehicleDescription parts = vehicle.reversed ? reversed(vehicle.data.parts) : vehicle.data.parts;
    first_body_.push_back(static_cast<int>(train.bodies.size()));
    add(parts, x, coach, "", [&](int body) { return first_body_.back() + body; });
  }

  void add_joint(const ConsistVehicle& ahead, const ConsistVehicle& behind, double x, int coach) {
    const VehicleData& joint = *ahead.joint;
    const VehicleDescription parts = ahead.joint_reversed ? reversed(joint.parts) : joint.parts;
    std::vector<int> number;  // in the train
    int next = static_cast<int>(train.bodies.size());
    for (std::size_t b = 0; b < parts.bodies.size(); ++b) {
      const std::string& name = joint.parts.bodies[b].name;  // as the joint's file sees it
      if (!of_neighbour(joint.parts.bodies[b])) {
        number.push_back(next++);
        continue;
      }
      const bool is_ahead = name.starts_with(of_vehicle_ahead) != ahead.joint_reversed;
      const std::size_t c = static_cast<std::size_t>(coach) + (is_ahead ? 0 : 1);
      const int body = body_of(is_ahead ? ahead : behind, name.substr(name.find('/') + 1), ahead.joint_reversed);
      if (body < 0) {
        throw input_error(fmt::format("{}: joins", joint.place), fmt::format("body '{}'", name),
                          fmt::format("a body of {}", (is_ahead ? ahead : behind).data.name));
      }
      number.push_back(first_body_[c] + body);
    }
    add(parts, x, coach, "joint-", [&](int body) { return number[static_cast<std::size_t>(body)]; });
  }

  void finish() {
    const auto x = [&](const Wheelset& w) { return train.bodies[static_cast<std::size_t>(w.body)].position.x(); };
    std::stable_sort(wheelset_.begin(), wheelset_.end(),
                     [&](const Wheelset& a, const Wheelset& b) { return x(a) > x(b); });
    for (const Wheelset& w : wheelset_) {
      train.wheelsets.push_back(w.body);
      train.wheel_radius.push_back(w.radius);
    }
  }

  VehicleDescription train;

 private:
  static int body_of(const ConsistVehicle& vehicle, const std::string& name, bool turned) {
    const std::vector<RigidBody>& bodies = vehicle.data.parts.bodies;
    if (turned == vehicle.reversed) {
      const auto found = std::find_if(bodies.begin(), bodies.end(), [&](const RigidBody& b) { return b.name == name; });
      return found == bodies.end() ? -1 : static_cast<int>(found - bodies.begin());
    }
    const std::vector<std::string> names = turned_names(bodies);
    const auto found = std::find(names.begin(), names.end(), name);
    return found == names.end() ? -1 : static_cast<int>(found - names.begin());
  }

  template <class Number>
  void add(const VehicleDescription& parts, double x, int coach, std::string_view prefix, const Number& number) {
    const Eigen::Vector3d shift(x, 0.0, 0.0);
    for (const RigidBody& body : parts.bodies) {
      if (of_neighbour(body)) continue;
      train.bodies.push_back(body);
      train.bodies.back().name = fmt::format("{}{}", prefix, body.name);
      train.bodies.back().position += shift;
      train.bodies.back().coach = coach;
    }
    for (const int wheelset : parts.wheelsets) {
      wheelset_.push_back({number(wheelset), parts.nominal_radius});
    }
    for (const Suspension& unit : parts.suspension) {
      train.suspension.push_back(unit);
      Suspension& added = train.suspension.back();
      added.body_a = number(unit.body_a);
      added.body_b = number(unit.body_b);
      added.point += shift;
    }
  }

  struct Wheelset {
    int body;
    double radius;
  };
  std::vector<int> first_body_;  // of each vehicle
  std::vector<Wheelset> wheelset_;
};

void check_plane(const std::vector<ConsistVehicle>& train, MotionPlane plane) {
  const auto vertical = [](const VehicleData& data) { return data.motion == MotionPlane::vertical; };
  for (const ConsistVehicle& vehicle : train) {
    if (vertical(vehicle.data) && plane != MotionPlane::vertical) {
      throw input_error(fmt::format("{}: motion", vehicle.data.place), "\"vertical\", and a model with lateral motion",
                        "contact.normal = \"rigid\", or a file with the lateral values too");
    }
    if (!vehicle.joint || vertical(*vehicle.joint)) continue;
    const std::size_t next = static_cast<std::size_t>(&vehicle - train.data()) + 1;
    if (!vertical(vehicle.data) && !vertical(train[next].data)) continue;
    throw input_error(fmt::format("{}: motion", vehicle.joint->place), "\"spatial\" between vehicles of vertical data",
                      "motion = \"vertical\", as in the vehicles' files");
  }
}

void add_sentences(const std::vector<std::string>& from, std::string_view name, std::vector<std::string>& to) {
  for (const std::string& sentence : from) {
    std::string named = fmt::format("{}: {}", name, sentence);
    if (std::find(to.begin(), to.end(), named) == to.end()) to.push_back(std::move(named));
  }
}

void add_sentences(const VehicleData& data, bool linear, VehicleModel& model) {
  add_sentences(linear ? data.linearised : data.stand_ins, data.name, model.linearised);
  if (linear) {
    add_sentences(data.left_out, data.name, model.left_out);
  } else {
    add_sentences(data.nonlinear, data.name, model.nonlinear);
  }
}

}  // namespace

std::optional<ConsistEntry> parse_consist_entry(std::string_view text) {
  constexpr int most = 100;
  ConsistEntry entry;
  if (text.starts_with('-')) {
    entry.reversed = true;
    text.remove_prefix(1);
  }
  if (const std::size_t star = text.rfind('*'); star != text.npos) {
    const std::string_view digits = text.substr(star + 1);
    const auto [stop, status] = std::from_chars(digits.data(), digits.data() + digits.size(), entry.count);
    if (status != std::errc() || stop != digits.data() + digits.size() || entry.count < 1 || entry.count > most) {
      return {};
    }
    text = text.substr(0, star);
  }
  if (text.empty()) return {};
  entry.vehicle = text;
  return entry;
}

std::vector<ConsistVehicle> read_consist(const std::vector<ConsistEntry>& entries, const std::filesystem::path& joint) {
  std::map<std::string, VehicleData> read;
  std::vector<ConsistVehicle> train;
  for (const ConsistEntry& entry : entries) {
    auto known = read.find(entry.vehicle);
    if (known == read.end()) known = read.emplace(entry.vehicle, find_vehicle(entry.vehicle)).first;
    for (int i = 0; i < entry.count; ++i) train.push_back({known->second, entry.reversed, {}, false});
  }
  for (const auto& [name, data] : read) require_closing(data);
  for (std::size_t v = 0; v + 1 < train.size(); ++v) add_joint(train[v], train[v + 1], joint);
  return train;
}

VehicleDescription reversed(const VehicleDescription& parts) {
  const Eigen::DiagonalMatrix<double, 3> half_turn(-1.0, -1.0, 1.0);
  VehicleDescription turned = parts;
  const std::vector<std::string> names = turned_names(parts.bodies);
  for (std::size_t b = 0; b < turned.bodies.size(); ++b) {
    turned.bodies[b].name = names[b];
    turned.bodies[b].position = half_turn * parts.bodies[b].position;
  }
  for (Suspension& unit : turned.suspension) unit.point = half_turn * unit.point;
  std::reverse(turned.wheelsets.begin(), turned.wheelsets.end());
  return turned;
}

VehicleDescription describe_consist(const std::vector<ConsistVehicle>& train) {
  TrainParts parts;
  double x = 0.0;
  std::vector<double> centre;
  for (std::size_t v = 0; v < train.size(); ++v) {
    const double length = train[v].data.parts.length;
    if (v > 0) x -= 0.5 * (train[v - 1].data.parts.length + length);
    centre.push_back(x);
    parts.train.length = v == 0 ? length : parts.train.length + length;
    parts.add_vehicle(train[v], x, static_cast<int>(v));
  }
  for (std::size_t v = 0; v + 1 < train.size(); ++v) {
    if (!train[v].joint) continue;
    parts.add_joint(train[v], train[v + 1], centre[v] - 0.5 * train[v].data.parts.length, static_cast<int>(v));
  }
  parts.finish();
  parts.train.name = "the train of " + consist_text(train);
  parts.train.nominal_radius = train.front().data.parts.nominal_radius;
  parts.train.coaches = static_cast<int>(train.size());
  return std::move(parts.train);
}

VehicleModel build_consist(const std::vector<ConsistVehicle>& train, MotionPlane plane, const VehicleWeight& weight,
                           ForceElementChoice choice) {
  check_plane(train, plane);
  VehicleDescription parts = describe_consist(train);
  parts.weight = weight;
  parts.force_elements = choice;
  parts.held_dofs = held_motions(parts, plane);
  for (std::size_t b = 0; b < parts.bodies.size(); ++b) {
    const VehicleData& data = train[static_cast<std::size_t>(parts.bodies[b].coach)].data;
    if (data.motion == MotionPlane::vertical) parts.held_dofs[b][0] = held;
  }
  VehicleModel model = assemble_vehicle(parts);
  const bool linear = choice == ForceElementChoice::linear;
  for (const ConsistVehicle& vehicle : train) {
    const double top = vehicle.data.top_speed;
    if (top > 0.0 && (model.top_speed == 0.0 || top < model.top_speed)) model.top_speed = top;
    add_sentences(vehicle.data, linear, model);
    if (vehicle.joint) add_sentences(*vehicle.joint, linear, model);
  }
  return model;
}

std::string consist_text(const std::vector<ConsistVehicle>& train) {
  std::vector<std::pair<std::string, int>> kinds;
  for (const ConsistVehicle& vehicle : train) {
    const auto known =
        std::find_if(kinds.begin(), kinds.end(), [&](const auto& kind) { return kind.first == vehicle.data.name; });
    if (known == kinds.end()) {
      kinds.emplace_back(vehicle.data.name, 1);
    } else {
      ++known->second;
    }
  }
  std::vector<std::string> words;
  for (const auto& [name, count] : kinds) words.push_back(fmt::format("{} x {}", count, name));
  return fmt::format("{}", fmt::join(words, ", "));
}

}  // namespace railtab
