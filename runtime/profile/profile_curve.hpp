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

/// A profile as a piecewise cubic curve in arc length, for fast evaluation.
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
    return s >= start_[piece] && s <= start_[piece + 1];
  }
  /// Arc length at which a piece begins.
  [[nodiscard]] double piece_begin(std::size_t piece) const noexcept { return start_[piece]; }
  /// The eight coefficients y0 z0 y1 z1 y2 z2 y3 z3 of a piece's cubics in s - piece_begin(piece); 64-byte aligned.
  [[nodiscard]] const double* piece_coefficients(std::size_t piece) const noexcept { return &piece_[piece].y0; }
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
  /// turned little, so that a few terms of the arc sine's series do.
  /// @param inverse_speed 1/sqrt(dy² + dz²)
  [[nodiscard]] double tangent_angle(std::size_t piece, double dy, double dz, double inverse_speed) const noexcept {
    constexpr double series_limit = 0.05;  // the first term left out is 4e-18 of the result
    const Tangent& begin = tangent_[piece];
    const double sine = (begin.y * dz - begin.z * dy) * inverse_speed;
    if (!(std::abs(sine) < series_limit)) return std::atan2(dz, dy);
    const double x = sine * sine;
    const double series = 1.0 / 6 + x * (3.0 / 40 + x * (5.0 / 112 + x * (35.0 / 1152 + x * (63.0 / 2816))));
    return begin.angle + (sine + sine * x * series);
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
    double y0, z0, y1, z1, y2, z2, y3, z3;
  };
  struct Tangent {  // of unit length
    double angle, y, z;
  };

  void fill_buckets();

  [[nodiscard]] std::size_t interval(double s) const noexcept {
    const double q = s * bucket_inverse_width_ - bucket_offset_;
    std::size_t i =
        bucket_[static_cast<std::size_t>(static_cast<std::int64_t>(q > 0 ? (q < last_bucket_ ? q : last_bucket_) : 0))];
    if (s >= start_[i + 1]) [[unlikely]] {  // rarely: the processor need not wait for the answer
      while (i + 1 < piece_.size() && s >= start_[i + 1]) ++i;
    }
    return i;
  }

  ProfileKnots knots_;
  std::vector<Piece> piece_;           // one per interval between knots
  std::vector<double> start_;          // arc length at which each piece begins, and the end
  std::vector<Tangent> tangent_;       // there
  std::vector<std::uint32_t> bucket_;  // first interval that reaches into each uniform bucket of s
  double bucket_inverse_width_ = 0.0;  // s of a bucket's beginning times this, less the offset, is its number
  double bucket_offset_ = 0.0;
  double last_bucket_ = 0.0;  // its number
};

}  // namespace railtab
