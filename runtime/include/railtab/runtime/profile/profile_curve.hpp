#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "railtab/tables/profile_knots.hpp"

namespace railtab {

/// Value and first two derivatives of a profile curve at one arc length.
struct CurvePoint {
  double y, z;      ///< [m]
  double dy, dz;    ///< d/ds [-]
  double ddy, ddz;  ///< d²/ds² [1/m]

  /// Signed curvature dy·ddz − dz·ddy over |t|³ [1/m]: positive where the curve bends towards +z.
  /// A convex rail head has a positive value, a convex wheel tread a negative one.
  [[nodiscard]] double curvature() const noexcept {
    const double t2 = dy * dy + dz * dz;
    return (dy * ddz - dz * ddy) / (t2 * std::sqrt(t2));
  }
};

/// A profile as a piecewise cubic curve in arc length, made for fast evaluation.
///
/// Invariant: at least two knots, arc length strictly increasing, all values finite.
/// Evaluation is const, allocation-free and thread-safe.
class ProfileCurve {
 public:
  /// @throws InputError naming the profile and the first knot that breaks the invariant.
  explicit ProfileCurve(ProfileKnots knots);

  /// Point at arc length s; outside [s_begin, s_end] the end piece is continued, so that Newton may
  /// step over the end; callers judge the final s with contains().
  [[nodiscard]] CurvePoint at(double s) const noexcept { return on_piece(piece_of(s), s); }

  /// The cubic piece that at(s) takes.
  [[nodiscard]] std::size_t piece_of(double s) const noexcept { return interval(s); }
  /// Whether s lies on that piece, its ends included.
  [[nodiscard]] bool piece_contains(std::size_t piece, double s) const noexcept {
    return s >= start_[piece] && !(s > start_[piece + 1]);
  }
  /// Point at arc length s of one cubic piece, continued beyond its ends.
  [[nodiscard]] CurvePoint on_piece(std::size_t piece, double s) const noexcept {
    const Piece& p = piece_[piece];
    const double t = s - start_[piece];
    return {p.y0 + t * (p.y1 + t * (p.y2 + t * p.y3)),
            p.z0 + t * (p.z1 + t * (p.z2 + t * p.z3)),
            p.y1 + t * (2 * p.y2 + t * 3 * p.y3),
            p.z1 + t * (2 * p.z2 + t * 3 * p.z3),
            2 * p.y2 + t * 6 * p.y3,
            2 * p.z2 + t * 6 * p.z3};
  }

  /// atan2(dz, dy) of a point of a piece, to rounding: from the piece's beginning, where it is known, the tangent has
  /// turned little, so that a few terms of the series do.
  [[nodiscard]] double tangent_angle(std::size_t piece, const CurvePoint& point) const noexcept {
    constexpr double series_limit = 0.05;  // the first term left out is 2e-17
    const Piece& p = piece_[piece];
    const double turn = (p.y1 * point.dz - p.z1 * point.dy) / (p.y1 * point.dy + p.z1 * point.dz);
    if (!(std::abs(turn) < series_limit)) return std::atan2(point.dz, point.dy);
    const double x = turn * turn;
    return start_angle_[piece] +
           turn * (1 - x * (1.0 / 3 - x * (1.0 / 5 - x * (1.0 / 7 - x * (1.0 / 9 - x * (1.0 / 11))))));
  }

  [[nodiscard]] double s_begin() const noexcept { return knots_.s.front(); }
  [[nodiscard]] double s_end() const noexcept { return knots_.s.back(); }
  [[nodiscard]] bool contains(double s) const noexcept { return s >= s_begin() && s <= s_end(); }
  [[nodiscard]] const ProfileKnots& knots() const noexcept { return knots_; }

  /// Arc length of the point at `y` [m], for set-up code. Where an outline passes `y` several times (undercut
  /// flank), the point that faces the other body: greatest z of a wheel, least z of a rail. Where it never does,
  /// the knot of the nearest y.
  [[nodiscard]] double s_at_y(double y) const noexcept;

  /// Arc length of the highest point (least z), for set-up code: the origin of a rail profile.
  [[nodiscard]] double s_at_highest_point() const noexcept;

 private:
  struct alignas(64) Piece {  // one cache line
    double y0, y1, y2, y3, z0, z1, z2, z3;
  };

  void fill_buckets();

  [[nodiscard]] std::size_t interval(double s) const noexcept {
    const double q = (s - bucket_origin_) * bucket_inverse_width_;
    const double last = static_cast<double>(bucket_.size() - 1);
    std::size_t i = bucket_[static_cast<std::size_t>(q > 0 ? (q < last ? q : last) : 0)];
    i += static_cast<std::size_t>(s >= start_[i + 1]);  // half of the queries, unpredictable: without a branch
    while (s >= start_[i + 1]) ++i;                     // only where knots crowd
    return i;
  }

  ProfileKnots knots_;
  std::vector<Piece> piece_;           // one per interval between knots
  std::vector<double> start_;          // arc length at which each piece begins, and a NaN that ends every walk
  std::vector<double> start_angle_;    // atan2(dz, dy) there
  std::vector<std::uint32_t> bucket_;  // first interval that reaches into each uniform bucket of s
  double bucket_origin_ = 0.0;
  double bucket_inverse_width_ = 0.0;
};

}  // namespace railtab
