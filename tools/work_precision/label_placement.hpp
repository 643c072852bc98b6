#pragma once

#include <string>
#include <utility>
#include <vector>

namespace railtab::work_precision {

/// A rectangle of the drawing, y downward [px].
struct Box {
  double left, top, right, bottom;
};

/// Where a label stands.
struct LabelPlace {
  double x, y;         ///< of the text's baseline, at its anchor
  const char* anchor;  ///< start, middle or end
  bool far;            ///< so far from its point that a line has to join them
};

/// Finds places for the labels of points: inside the frame, and over neither points nor other labels where there is
/// room.
class LabelPlacement {
 public:
  LabelPlacement(const Box& frame, double font_size) : frame_(frame), font_size_(font_size) {}
  /// Keeps labels off.
  void occupy(const Box& box) { occupied_.push_back(box); }
  /// Keeps labels off a straight line where there is room beside it.
  void cross(double x0, double y0, double x1, double y1);
  /// The best place beside the point, which it then occupies.
  LabelPlace place(double x, double y, const std::string& text);

 private:
  [[nodiscard]] double overlap(const Box& box) const;

  Box frame_;
  double font_size_;
  std::vector<Box> occupied_;
  std::vector<std::pair<double, double>> crossed_;  // points along lines, as far apart as a letter is wide
};

}  // namespace railtab::work_precision
