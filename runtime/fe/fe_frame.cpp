#include "railtab/runtime/fe/fe_frame.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <Eigen/LU>
#include <array>
#include <cmath>
#include <string_view>

#include "railtab/runtime/base/input_error.hpp"
#include "railtab/runtime/base/text_lines.hpp"

namespace railtab {

namespace {

struct UnitSystem {
  std::string_view name;
  double length, force;  // in m and N; the unit of mass follows with the second
};
constexpr std::array<UnitSystem, 3> unit_systems{{{"m-N-kg", 1.0, 1.0}, {"mm-N-t", 1e-3, 1.0}, {"m-kN-t", 1.0, 1e3}}};

const UnitSystem& unit_system(const FeFrame& frame, const std::string& section) {
  for (const UnitSystem& system : unit_systems) {
    if (system.name == frame.units) return system;
  }
  throw input_error(section + ".units", frame.units, fmt::format("one of {}", fmt::join(fe_unit_systems(), ", ")));
}

/// Rows: railtab's x, y, z in the model's axes.
Eigen::Matrix3d rotation(const FeFrame& frame, const std::string& section) {
  const auto rejection = [&](std::string_view found) {
    return input_error(section + ".axes", fmt::format("\"{}\"{}", frame.axes, found),
                       "the model's directions forward, right and down, right-handed, like \"x -y -z\"");
  };
  std::array<std::string_view, 3> words;
  if (split(frame.axes, words) != 3) throw rejection("");
  Eigen::Matrix3d P = Eigen::Matrix3d::Zero();
  for (int i = 0; i < 3; ++i) {
    std::string_view word = words[static_cast<std::size_t>(i)];
    const double sign = word.starts_with('-') ? -1.0 : 1.0;
    if (word.starts_with('-') || word.starts_with('+')) word.remove_prefix(1);
    if (word.size() != 1 || word[0] < 'x' || word[0] > 'z') throw rejection("");
    P(i, word[0] - 'x') = sign;
  }
  const double determinant = P.determinant();
  if (determinant == 0.0) throw rejection(", an axis twice");
  if (determinant < 0.0) throw rejection(", left-handed");
  return P;
}

}  // namespace

std::vector<std::string> fe_unit_systems() {
  std::vector<std::string> names;
  for (const UnitSystem& system : unit_systems) names.emplace_back(system.name);
  return names;
}

FrameConversion::FrameConversion(const FeFrame& frame, const std::string& section)
    : P_(rotation(frame, section)), origin_(Eigen::Vector3d::Map(frame.origin.value().data())) {
  const UnitSystem& units = unit_system(frame, section);
  length_ = units.length;
  force_ = units.force;
}

Eigen::Vector3d FrameConversion::position(const Eigen::Vector3d& of_model) const {
  return length_ * (P_ * (of_model - origin_));
}

FrameConversion::Row FrameConversion::row(int motion_of_model) const {
  const bool turns = motion_of_model >= 3;
  int axis = 0;
  const double sign = P_.col(motion_of_model % 3).cwiseAbs().maxCoeff(&axis) * P_.col(motion_of_model % 3).sum();
  return {axis + (turns ? 3 : 0), sign * std::sqrt(force_ * length_) / (turns ? 1.0 : length_)};
}

double FrameConversion::inner_to_model() const { return std::sqrt(force_ * length_); }

}  // namespace railtab
