#pragma once

// What an input of CalculiX may have beside a mesh of shells: points that nodes carry, rigid bodies, springs, rails.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace railtab::calculix {

/// Part of the motion of a node, along `dof` 1, 2, 3 (x, y, z).
struct Term {
  int node, dof;
  double factor;
};
using Sum = std::vector<Term>;

inline std::string in_input(double number) {
  char digits[32];
  std::snprintf(digits, sizeof digits, "%.11e", number);
  return digits;
}

class Parts {
 public:
  /// @param held some of 1, 2, 3, and 4 for the rotation of a beam about x
  int node(const std::vector<int>& held, const std::array<double, 3>& place = {}) {
    nodes_ += text(++last_node_);
    for (const double along : place) nodes_ += ", " + in_input(along);
    nodes_ += "\n";
    place_[last_node_] = place;
    for (const int dof : held) hold(last_node_, dof);
    return last_node_;
  }
  /// Its motion along x, y, z is these sums; an empty one: none.
  int point(const std::array<Sum, 3>& motion) {
    const int number = node({});
    for (std::size_t k = 0; k < 3; ++k) {
      const int dof = static_cast<int>(k) + 1;
      if (motion[k].empty()) {
        hold(number, dof);
        continue;
      }
      equations_ += "*EQUATION\n" + text(static_cast<int>(motion[k].size()) + 1) + "\n";
      equations_ += text(number) + ", " + text(dof) + ", -1.\n";
      for (const auto& [of, along, factor] : motion[k]) {
        equations_ += text(of) + ", " + text(along) + ", " + in_input(factor) + "\n";
      }
    }
    return number;
  }
  void spring(int a, int b, int dof, double k) {
    springs_[{dof, k}] += text(++last_element_) + ", " + text(a) + ", " + text(b) + "\n";
  }
  /// Elements B32R of a rectangular section of these A and I. @param ends of the elements, in their order along x
  void beam(const std::string& name, const std::vector<int>& ends, double A, double I) {
    beams_ += "*ELEMENT, TYPE=B32R, ELSET=" + name + "\n";
    for (std::size_t n = 1; n < ends.size(); ++n) {
      std::array<double, 3> middle{};
      for (std::size_t k = 0; k < 3; ++k) middle[k] = 0.5 * (place_.at(ends[n - 1])[k] + place_.at(ends[n])[k]);
      const int between = node({}, middle);
      beams_ += text(++last_element_) + ", " + text(ends[n - 1]) + ", " + text(between) + ", " + text(ends[n]) + "\n";
    }
    const double height = std::sqrt(12.0 * I / A);
    beams_ += "*BEAM SECTION, ELSET=" + name + ", MATERIAL=STEEL, SECTION=RECT\n" + in_input(height) + ", " +
              in_input(A / height) + "\n0., 0., 1.\n";
  }

  /// @param E of the beams [Pa]
  [[nodiscard]] std::string input(double E) const {
    std::string all =
        "*NODE\n" + nodes_ + "*MATERIAL, NAME=STEEL\n*ELASTIC\n" + in_input(E) + ", 0.3\n" + beams_ + equations_;
    int set = 0;
    for (const auto& [key, elements] : springs_) {
      const std::string name = "SPRINGS" + text(++set), dof = text(key.first);
      all += "*ELEMENT, TYPE=SPRING2, ELSET=" + name + "\n" + elements;
      all += "*SPRING, ELSET=" + name + "\n" + dof + ", " + dof + "\n" + in_input(key.second) + "\n";
    }
    return all + "*BOUNDARY\n" + held_;
  }

 private:
  static std::string text(int number) { return std::to_string(number); }
  void hold(int node, int dof) { held_ += text(node) + ", " + text(dof) + ", " + text(dof) + "\n"; }

  int last_node_ = 10000, last_element_ = 10000;  // the mesh has smaller numbers
  std::string nodes_, equations_, beams_, held_;
  std::map<int, std::array<double, 3>> place_;
  std::map<std::pair<int, double>, std::string> springs_;  // by dof and stiffness
};

/// Displacements of one node, rotations about x, y, z of another.
struct Body {
  int centre = 0, rotation = 0;
  /// Motion of a point at r from the centre: u + θ × r.
  [[nodiscard]] std::array<Sum, 3> at(double x, double y, double z) const {
    return {Sum{{centre, 1, 1.0}, {rotation, 2, z}, {rotation, 3, -y}},
            Sum{{centre, 2, 1.0}, {rotation, 1, -z}, {rotation, 3, x}},
            Sum{{centre, 3, 1.0}, {rotation, 1, y}, {rotation, 2, -x}}};
  }
  /// The same along z alone.
  [[nodiscard]] std::array<Sum, 3> vertically_at(double x, double y) const { return {Sum{}, Sum{}, at(x, y, 0.0)[2]}; }
};

/// A rail and where along x its beam has nodes.
struct Rail {
  std::vector<double> x;
  std::vector<int> node;
  [[nodiscard]] int at(double place) const {
    const auto nearest = std::min_element(
        x.begin(), x.end(), [place](double a, double b) { return std::abs(a - place) < std::abs(b - place); });
    return node[static_cast<std::size_t>(nearest - x.begin())];
  }
};

}  // namespace railtab::calculix
