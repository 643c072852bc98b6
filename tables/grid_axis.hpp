#pragma once

#include <string>
#include <vector>

namespace railtab {

/// An axis of a table: strictly increasing nodes, or a single node for a quantity held fixed.
class GridAxis {
 public:
  /// @throws InputError naming the axis and the first node that breaks the order.
  GridAxis(const std::string& name, std::vector<double> nodes);

  struct Cell {
    int index;        ///< left node
    double fraction;  ///< position in the cell, 0..1
    double width;     ///< of the cell; 0 on an axis of one node
    bool inside;      ///< false outside the axis: leaving the table is a status, never a clamp
  };
  /// The cell that holds `value`; on an axis of one node, inside means within 1e-12 of it. NaN is outside.
  [[nodiscard]] Cell locate(double value) const noexcept;

  [[nodiscard]] int size() const noexcept { return static_cast<int>(nodes_.size()); }

 private:
  std::vector<double> nodes_;
  bool uniform_ = false;
  double inverse_step_ = 0.0;
};

}  // namespace railtab
