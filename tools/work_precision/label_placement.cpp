#include "label_placement.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

namespace railtab::work_precision {

namespace {

constexpr double mean_letter = 0.56;    // width of a letter over the size of the font
constexpr double outside_frame = 10.0;  // an area there counts so many times one that is occupied
constexpr double crossed_letter = 4.0;  // a letter under a line counts as so much area occupied [px²]
constexpr std::array near_rings{9.0};
constexpr std::array far_rings{20.0, 32.0, 44.0, 58.0, 74.0, 92.0};  // [px]
constexpr int directions = 16;

double area(const Box& b) { return std::max(0.0, b.right - b.left) * std::max(0.0, b.bottom - b.top); }

Box common(const Box& a, const Box& b) {
  return {std::max(a.left, b.left), std::max(a.top, b.top), std::min(a.right, b.right), std::min(a.bottom, b.bottom)};
}

}  // namespace

double LabelPlacement::overlap(const Box& box) const {
  double sum = outside_frame * (area(box) - area(common(box, frame_)));
  for (const Box& other : occupied_) sum += area(common(box, other));
  for (const auto& [x, y] : crossed_) {
    if (x > box.left && x < box.right && y > box.top && y < box.bottom) sum += crossed_letter;
  }
  return sum;
}

void LabelPlacement::cross(double x0, double y0, double x1, double y1) {
  const int count = 1 + static_cast<int>(std::hypot(x1 - x0, y1 - y0) / (mean_letter * font_size_));
  for (int i = 0; i <= count; ++i) {
    const double s = static_cast<double>(i) / count;
    crossed_.emplace_back(x0 + s * (x1 - x0), y0 + s * (y1 - y0));
  }
}

LabelPlace LabelPlacement::place(double x, double y, const std::string& text) {
  const auto letters = static_cast<double>(
      std::count_if(text.begin(), text.end(), [](unsigned char c) { return (c & 0xC0U) != 0x80U; }));  // of UTF-8
  const double width = mean_letter * font_size_ * letters;
  LabelPlace best{x, y, "start", false};
  Box best_box{};
  double least = std::numeric_limits<double>::infinity();
  const auto consider = [&](double ring, bool far) {
    for (int k = 0; k < directions; ++k) {
      const double angle = 2.0 * std::numbers::pi * k / directions;
      const double dx = ring * std::cos(angle), dy = -ring * std::sin(angle);
      const bool above_or_below = std::abs(dx) < 0.3 * ring;
      const char* const anchor = above_or_below ? "middle" : dx > 0.0 ? "start" : "end";
      const double shift = above_or_below ? 0.5 * width : dx > 0.0 ? 0.0 : width;
      const double baseline = y + dy + 0.35 * font_size_;
      const Box box{x + dx - shift, baseline - 0.8 * font_size_, x + dx - shift + width, baseline + 0.2 * font_size_};
      // of equal places the nearest, and to the right or above before the left and below
      const double cost = overlap(box) + 0.1 * ring + 0.05 * std::min(k, directions - k);
      if (cost >= least) continue;
      least = cost;
      best = {x + dx, baseline, anchor, far};
      best_box = box;
    }
  };
  for (const double ring : near_rings) consider(ring, false);
  for (const double ring : far_rings) consider(ring, true);
  occupy(best_box);
  return best;
}

}  // namespace railtab::work_precision
