// The ellipse that patch_loads() makes of the overlap, against the half-space solution of the same overlap: pressures
// of rectangular elements (Boussinesq, Love's integral), non-negative, found by conjugate gradients on the contact area
// at given approach [PolonskyKeer1999]. An independent route: it knows neither ellipses nor curvatures.

#include <fftw3.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include "../measured.hpp"
#include "railtab/runtime/contact/contact_search.hpp"
#include "railtab/runtime/contact/overlap.hpp"
#include "railtab/runtime/contact/patch_loads.hpp"
#include "railtab/runtime/profile/standard_profiles.hpp"

namespace railtab {
namespace {

/// Normal contact of an elastic half-space on a grid of nx x ny elements.
class HalfSpace {
 public:
  static constexpr int nx = 40, ny = 120;

  HalfSpace() : field_(fftw_alloc_real(width * height)), spectrum_(fftw_alloc_complex(frequencies)) {
    forward_ = fftw_plan_dft_r2c_2d(height, width, field_, spectrum_, FFTW_ESTIMATE);
    backward_ = fftw_plan_dft_c2r_2d(height, width, spectrum_, field_, FFTW_ESTIMATE);
  }
  ~HalfSpace() {
    fftw_destroy_plan(forward_);
    fftw_destroy_plan(backward_);
    fftw_free(field_);
    fftw_free(spectrum_);
  }
  HalfSpace(const HalfSpace&) = delete;
  HalfSpace& operator=(const HalfSpace&) = delete;

  /// Total force [N] for an undeformed overlap h [m] given at the element centres, x fastest; elements hx x hy.
  double force(const std::vector<double>& h, double hx, double hy, double contact_modulus) {
    set_influence(hx, hy, contact_modulus);
    std::vector<double> p(h.size()), gap(h.size()), direction(h.size(), 0.0);
    for (std::size_t k = 0; k < h.size(); ++k) p[k] = h[k] > 0.0 ? 1e2 * contact_modulus * h[k] : 0.0;
    double norm_before = 1.0, keep = 0.0;
    for (int iteration = 0; iteration < 500; ++iteration) {
      const std::vector<double> u = displacement(p);
      double norm = 0.0;
      for (std::size_t k = 0; k < h.size(); ++k) {
        gap[k] = u[k] - h[k];
        if (p[k] > 0.0) norm += gap[k] * gap[k];
      }
      for (std::size_t k = 0; k < h.size(); ++k) {
        direction[k] = p[k] > 0.0 ? gap[k] + keep * norm / norm_before * direction[k] : 0.0;
      }
      norm_before = norm;
      const std::vector<double> along = displacement(direction);
      double numerator = 0.0, denominator = 0.0;
      for (std::size_t k = 0; k < h.size(); ++k) {
        numerator += p[k] > 0.0 ? gap[k] * direction[k] : 0.0;
        denominator += p[k] > 0.0 ? along[k] * direction[k] : 0.0;
      }
      const double step = numerator / denominator;
      double change = 0.0, sum = 0.0;
      keep = 1.0;
      for (std::size_t k = 0; k < h.size(); ++k) {
        const double before = p[k];
        if (before > 0.0) {
          p[k] = std::max(0.0, before - step * direction[k]);
        } else if (gap[k] < 0.0) {
          p[k] = -step * gap[k];
          keep = 0.0;
        }
        change += std::abs(p[k] - before);
        sum += p[k];
      }
      if (iteration > 3 && change < 1e-7 * sum) break;
    }
    double total = 0.0;
    for (const double pressure : p) total += pressure;
    return total * hx * hy;
  }

 private:
  static constexpr int width = 2 * nx, height = 2 * ny, frequencies = height * (nx + 1);

  void set_influence(double hx, double hy, double contact_modulus) {
    const auto corner = [](double x, double y) {
      return (x != 0.0 ? x * std::asinh(y / std::abs(x)) : 0.0) + (y != 0.0 ? y * std::asinh(x / std::abs(y)) : 0.0);
    };
    for (int j = 0; j < height; ++j) {
      for (int i = 0; i < width; ++i) {
        const double x = std::min(i, width - i) * hx;
        const double y = std::min(j, height - j) * hy;
        const double west = x - 0.5 * hx, east = x + 0.5 * hx, south = y - 0.5 * hy, north = y + 0.5 * hy;
        field_[j * width + i] =
            (corner(east, north) - corner(west, north) - corner(east, south) + corner(west, south)) /
            (std::numbers::pi * contact_modulus);
      }
    }
    fftw_execute(forward_);
    influence_.resize(frequencies);
    for (int k = 0; k < frequencies; ++k) influence_[static_cast<std::size_t>(k)] = spectrum_[k][0];  // even: real
  }

  std::vector<double> displacement(const std::vector<double>& p) {
    std::fill(field_, field_ + width * height, 0.0);
    for (int j = 0; j < ny; ++j) {
      for (int i = 0; i < nx; ++i) field_[j * width + i] = p[static_cast<std::size_t>(j * nx + i)];
    }
    fftw_execute(forward_);
    for (int k = 0; k < frequencies; ++k) {
      spectrum_[k][0] *= influence_[static_cast<std::size_t>(k)];
      spectrum_[k][1] *= influence_[static_cast<std::size_t>(k)];
    }
    fftw_execute(backward_);
    std::vector<double> u(static_cast<std::size_t>(nx * ny));
    for (int j = 0; j < ny; ++j) {
      for (int i = 0; i < nx; ++i) {
        u[static_cast<std::size_t>(j * nx + i)] = field_[j * width + i] / (width * height);
      }
    }
    return u;
  }

  double* field_;
  fftw_complex* spectrum_;
  fftw_plan forward_, backward_;
  std::vector<double> influence_;
};

/// Half-space force of the overlap around a patch. Along x the wheel is a parabola, across it is as the profiles are.
double half_space_force(HalfSpace& half_space, const WheelRailPair& pair, const WheelsetPose& pose,
                        const ContactPatch& patch, const ElasticMaterial& material) {
  const Overlap overlap(pair, pose);
  const OverlapEnds ends = overlap.ends(0.0, {&patch, pair.wheel().s_begin()}, {&patch, pair.wheel().s_end()});
  const double low = patch.s_wheel - ends.low;
  const double high = ends.high - patch.s_wheel;
  const double A = 0.5 * patch.curv_rolling;
  const double hx = 2.04 * std::sqrt(patch.penetration / A) / HalfSpace::nx;
  const double hy = 1.02 * (low + high) / HalfSpace::ny;
  std::vector<double> h;
  for (int j = 0; j < HalfSpace::ny; ++j) {
    const double across = 0.5 * (high - low) + (j - 0.5 * (HalfSpace::ny - 1)) * hy;
    const double penetration = overlap.at(patch.s_wheel + across, patch.s_rail + across).penetration;
    for (int i = 0; i < HalfSpace::nx; ++i) {
      const double x = (i - 0.5 * (HalfSpace::nx - 1)) * hx;
      h.push_back(penetration - A * x * x);
    }
  }
  return half_space.force(h, hx, hy, material.contact_modulus());
}

ContactGeometry s1002_on_60e1() {
  return ContactGeometry{ContactSearch(
      WheelRailPair(ProfileCurve(standard_profile(ProfileKind::wheel, "S1002", 0.0)),
                    ProfileCurve(standard_profile(ProfileKind::rail, "60E1", 1.0 / 40)), PairDimensions{}))};
}

// Where Hertz is exact the solver finds Hertz: flange contact inside the arcs of both profiles.
TEST(HalfSpaceContact, AgreesWithHertzWhereCurvaturesAreConstant) {
  const ContactGeometry geometry = s1002_on_60e1();
  const ContactSearch search(geometry.pair());
  HalfSpace half_space;
  const WheelsetPose pose{-6e-3, search.first_touch(-6e-3, 0.0, 0.0).z_touch + 15e-6, 0.0, 0.0};
  const ContactPatches patches = geometry.patches(pose);
  ASSERT_EQ(patches.count, 1);
  const ContactPatch& patch = patches.patch[0];
  const HertzContact hertz =
      hertz_contact(0.5 * patch.curv_rolling, 0.5 * (patch.curv_wheel + patch.curv_rail), ElasticMaterial{});
  const double exact = hertz.stiffness * std::pow(patch.penetration, 1.5);
  EXPECT_NEAR(half_space_force(half_space, geometry.pair(), pose, patch, ElasticMaterial{}) / exact, 1.0, 0.004);
}

TEST(HalfSpaceContact, ForceOfTheOverlapAtRandomPositions) {
  const ContactGeometry geometry = s1002_on_60e1();
  const ContactSearch search(geometry.pair());
  const NormalContactModel model;
  HalfSpace half_space;
  std::mt19937 generator(7);
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  int compared = 0;
  double squares = 0.0, largest = 0.0, point_squares = 0.0, point_largest = 0.0;
  for (int n = 0; n < 150; ++n) {
    const double y = -7e-3 + 14e-3 * uniform(generator);
    const double roll = -2e-3 + 4e-3 * uniform(generator);
    const double depth = 8e-6 * std::pow(10.0, uniform(generator));  // about 3 to 90 kN on the tread
    const TouchPoint touch = search.first_touch(y, roll, 0.0);
    const WheelsetPose pose{y, touch.z_touch + depth * std::hypot(1.0, touch.z_touch_dy), roll, 0.0};
    const ContactPatches patches = geometry.patches(pose);
    if (patches.count != 1) continue;
    const ContactPatch& patch = patches.patch[0];
    const double reference = half_space_force(half_space, geometry.pair(), pose, patch, model.material);
    const HertzContact point = hertz_contact(
        0.5 * patch.curv_rolling, std::max(0.5 * (patch.curv_wheel + patch.curv_rail), 1e-6), model.material);
    const double error = patch_loads(model, geometry, pose, patches)[0].elastic_force / reference - 1.0;
    const double point_error = point.stiffness * std::pow(patch.penetration, 1.5) / reference - 1.0;
    ++compared;
    squares += error * error;
    point_squares += point_error * point_error;
    largest = std::max(largest, std::abs(error));
    point_largest = std::max(point_largest, std::abs(point_error));
  }
  const double rms = std::sqrt(squares / compared), point_rms = std::sqrt(point_squares / compared);
  testing::measured("half_space.rms_percent", 100 * rms);
  testing::measured("half_space.largest_percent", 100 * largest);
  testing::measured("half_space.point_rms_percent", 100 * point_rms);
  testing::measured("half_space.point_largest_percent", 100 * point_largest);
  EXPECT_GT(compared, 100);
  EXPECT_LT(rms, 0.012);
  EXPECT_LT(largest, 0.045);
  EXPECT_GT(point_rms, 4.0 * rms);
}

}  // namespace
}  // namespace railtab
