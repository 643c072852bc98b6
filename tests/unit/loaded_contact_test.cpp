// The half-space solution of a wheel on its rail against what is known in closed form or by a second route.

#include "railtab/tablegen/loaded_contact.hpp"
#include "railtab/runtime/base/dense_solvers.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>
#include <vector>

#include "railtab/runtime/base/input_error.hpp"
#include "railtab/runtime/profile/standard_profiles.hpp"
#include "railtab/tablegen/loaded_column.hpp"

namespace railtab {
namespace {

const ContactSearch& s1002_on_60e1() {
  static const ContactSearch search(WheelRailPair(ProfileCurve(standard_profile(ProfileKind::wheel, "S1002", 0.0)),
                                                  ProfileCurve(standard_profile(ProfileKind::rail, "60E1", 1.0 / 40.0)),
                                                  PairDimensions{}));
  return search;
}

WheelsetPose lowered(double y, double roll, double yaw, double dz) {
  return {y, s1002_on_60e1().touch_height(y, roll, yaw) + dz, roll, yaw};
}

/// Influence of all elements on all others, from Love's integral written out.
Eigen::MatrixXd direct_influence(const NormalInfluence::Size& size, const std::vector<double>& angle, double modulus) {
  const auto corner = [](double x, double s) {
    const double r = std::hypot(x, s);
    return x * std::log(s + r) + s * std::log(x + r);
  };
  const int count = size.nx * size.ns;
  Eigen::MatrixXd matrix(count, count);
  for (int k = 0; k < count; ++k) {
    for (int l = 0; l < count; ++l) {
      const double x = (k % size.nx - l % size.nx) * size.dx, s = (k / size.nx - l / size.nx) * size.ds;
      const double west = x - 0.5 * size.dx, east = x + 0.5 * size.dx, south = s - 0.5 * size.ds,
                   north = s + 0.5 * size.ds;
      matrix(k, l) =
          (corner(east, north) - corner(west, north) - corner(east, south) + corner(west, south)) *
          std::cos(angle[static_cast<std::size_t>(k / size.nx)] - angle[static_cast<std::size_t>(l / size.nx)]) /
          (std::numbers::pi * modulus);
    }
  }
  return matrix;
}

TEST(NormalInfluence, IsTheDirectSumSymmetricAndPositive) {
  const NormalInfluence::Size size{6, 9, 0.3e-3, 0.1e-3};
  std::vector<double> angle;
  for (int j = 0; j < size.ns; ++j) angle.push_back(-1.3 + 0.25 * j);  // up to 2 rad between normals
  const double modulus = 113e9;
  NormalInfluence influence(size, angle, modulus);
  const Eigen::MatrixXd direct = direct_influence(size, angle, modulus);
  Eigen::VectorXd p(size.nx * size.ns), u(p.size());
  for (Eigen::Index k = 0; k < p.size(); ++k) p[k] = 1e9 * std::sin(1.7 * static_cast<double>(k * k) + 0.3);
  influence.apply(p, u);
  EXPECT_LT((u - direct * p).cwiseAbs().maxCoeff(), 1e-12 * (direct * p).cwiseAbs().maxCoeff());
  EXPECT_NEAR(influence.self(), direct(0, 0), 1e-12 * direct(0, 0));
  EXPECT_LT((direct - direct.transpose()).cwiseAbs().maxCoeff(), 1e-12 * direct(0, 0));
  EXPECT_GT(symmetric_spectrum(direct).values[0], 1e-3 * direct(0, 0));
}

// The point C(s) + h n(s) lies on the wheel: rotated back into the wheelset, its distance from the axle is that of the
// wheel profile at its place along the axle. And no other x is deeper than the line's.
TEST(UndeformedDistance, EndsOnTheWheelAtAnyPose) {
  const WheelRailPair& pair = s1002_on_60e1().pair();
  for (const WheelsetPose& pose :
       {lowered(-3e-3, 2e-3, 0.0, 5e-5), lowered(5e-3, -1e-3, 0.012, 8e-5), lowered(7e-3, 1e-3, -0.03, 2e-4)}) {
    const UndeformedDistance distance(pair, pose);
    const std::vector<SurfaceOverlap> regions = surface_overlaps(s1002_on_60e1(), pose, distance);
    ASSERT_FALSE(regions.empty());
    const Eigen::Matrix3d rotation =
        (Eigen::AngleAxisd(pose.roll, Eigen::Vector3d::UnitX()) * Eigen::AngleAxisd(pose.yaw, Eigen::Vector3d::UnitZ()))
            .toRotationMatrix();
    const WheelsetCentre centre = wheelset_centre(pair, pose);
    for (const SurfaceOverlap& region : regions) {
      for (int i = 1; i < 6; ++i) {
        const auto line = distance.line(region.s_low + (region.s_high - region.s_low) * i / 6.0);
        ASSERT_TRUE(line);
        for (const double x : {line->x - 4e-3, line->x, line->x + 7e-3}) {
          const auto depth = distance.at(*line, x, {line->overlap, line->s_wheel});
          ASSERT_TRUE(depth);
          EXPECT_LE(depth->overlap, line->overlap + 1e-12);
          const Eigen::Vector3d on_wheel =
              Eigen::Vector3d(x, line->y - centre.y, line->z - centre.z) +
              depth->overlap * Eigen::Vector3d(0.0, -std::sin(line->angle), std::cos(line->angle));
          const Eigen::Vector3d in_wheelset = rotation.transpose() * on_wheel;
          const CurvePoint wheel = pair.wheel().at(depth->s_wheel);
          EXPECT_NEAR(in_wheelset.y(), pair.tape_circle_offset() + wheel.y, 1e-12);
          EXPECT_NEAR(std::hypot(in_wheelset.x(), in_wheelset.z()), pair.nominal_radius() + wheel.z, 1e-12);
        }
      }
    }
  }
}

// A cone on the arc R300 of the rail head: Hertz's force, pressure and ellipse. Halving the elements changes the force
// by less than 0.1 %.
TEST(LoadedContact, IsHertzsWhereCurvaturesAreConstant) {
  const ContactSearch search(WheelRailPair(ProfileCurve(standard_profile(ProfileKind::wheel, "cone-1:40", 0.0)),
                                           ProfileCurve(standard_profile(ProfileKind::rail, "60E1", 1.0 / 40.0)),
                                           PairDimensions{}));
  const TouchPoint touch = search.first_touch(0.0, 0.0, 0.0);
  const double depth = 8e-6, cosine = 1.0 / std::hypot(1.0, touch.z_touch_dy);
  const WheelsetPose pose{0.0, touch.z_touch + depth / cosine, 0.0, 0.0};
  LoadedContactOptions options;
  const LoadedContact contact = loaded_contact(search, pose, options);
  ASSERT_TRUE(contact.converged);
  ASSERT_EQ(contact.bands.size(), 1u);
  const ContactPatches patches = search.patches(pose);
  const ContactPatch& patch = patches.patch[0];
  ASSERT_NEAR(1.0 / patch.curv_rail, 0.3, 1e-3);
  const HertzContact hertz =
      hertz_contact(0.5 * patch.curv_rolling, 0.5 * (patch.curv_wheel + patch.curv_rail), ElasticMaterial{});
  const double force = hertz.stiffness * std::pow(patch.penetration, 1.5);
  const double a = hertz.a1 * std::cbrt(force), b = hertz.b1 * std::cbrt(force);
  EXPECT_NEAR(contact.normal_force / force, 1.0, 1e-3);
  EXPECT_NEAR(contact.largest_pressure / (1.5 * force / (std::numbers::pi * a * b)), 1.0, 5e-3);
  EXPECT_NEAR(contact.bands[0].a / a, 1.0, 5e-3);
  EXPECT_NEAR(contact.bands[0].b / b, 1.0, 5e-3);
  EXPECT_NEAR(contact.area / (std::numbers::pi * a * b), 1.0, 0.02);
  // U = 2/5 F d
  EXPECT_NEAR(contact.elastic_energy / (0.4 * force * patch.penetration), 1.0, 2e-3);
  EXPECT_NEAR(contact.bands[0].angle, patch.angle, 1e-5);
  EXPECT_NEAR(contact.bands[0].rolling_radius, patch.rolling_radius, 1e-6);
  options.elements.across_narrowest = 80;
  const LoadedContact fine = loaded_contact(search, pose, options);
  EXPECT_NEAR(fine.normal_force / contact.normal_force, 1.0, 1e-3);
  EXPECT_LT(std::abs(fine.normal_force / force - 1.0), std::abs(contact.normal_force / force - 1.0));
}

// A cut that leaves a second part some nanometres of the last row under pressure, and less: its arc length has few
// digits of that width, its ellipse all of them.
TEST(LoadedContact, PartsOfNearlyNoWidthKeepTheirShape) {
  const WheelsetPose pose = lowered(1e-3, 0.0, 4e-3, 5e-5);
  const LoadedContact contact = loaded_contact(s1002_on_60e1(), pose, {});
  ASSERT_TRUE(contact.converged);
  const ContactElements& e = contact.elements;
  int last = e.ns - 1;
  while (contact.pressure.segment(static_cast<Eigen::Index>(last) * e.nx, e.nx).maxCoeff() <= 0.0) --last;
  const double end = e.line[static_cast<std::size_t>(last)].s + 0.5 * e.ds, w = std::pow(contact.elastic_energy, 0.2);
  double slenderness = 0.0;
  for (const double width : {0.5 * e.ds, 1e-8, 1e-10, 1e-12, 1e-14}) {
    const double cut = end - width, left = end - cut;
    const std::vector<LoadedPart> parts = loaded_parts(s1002_on_60e1(), contact, {cut}, w);
    ASSERT_EQ(parts.size(), 2U);
    EXPECT_NEAR(parts[1].s_rail, cut + 0.5 * left, 1e-16) << width;
    if (slenderness == 0.0) slenderness = parts[1].a / parts[1].b * left;
    EXPECT_NEAR(parts[1].a / parts[1].b * left / slenderness, 1.0, 1e-9) << width;
  }
}

// In the flange root a contact 14 mm wide presses most on a strip of 1 mm, which is no part of the overlap by itself.
TEST(LoadedContact, ResolvesARidgeOfPressure) {
  const WheelsetPose pose = lowered(7.857e-3, 2.509e-3, 3.678e-3, 2.379e-4);
  LoadedContactOptions options;
  options.elements.across_narrowest = 28;
  const LoadedContact c = loaded_contact(s1002_on_60e1(), pose, options);
  ASSERT_TRUE(c.converged);
  ASSERT_EQ(c.regions.size(), 1u);
  ASSERT_EQ(c.regions[0].parts.size(), 1u);
  EXPECT_GE(c.rows_across_peak, 8.0);
  ASSERT_GE(c.refinements, 2);
  const LoadedContact begun = loaded_contact(s1002_on_60e1(), pose, options, c.refinements - 1);
  EXPECT_EQ(begun.refinements, c.refinements) << "a last one shows whether those before suffice";
  EXPECT_EQ(begun.elements.ns, c.elements.ns);
  EXPECT_LT(begun.iterations, c.iterations);
  EXPECT_NEAR(begun.largest_pressure / c.largest_pressure, 1.0, 1e-4);
  options.elements.across_narrowest = 224;
  const LoadedContact fine = loaded_contact(s1002_on_60e1(), pose, options);
  EXPECT_NEAR(c.largest_pressure / fine.largest_pressure, 1.0, 0.01);
  EXPECT_NEAR(c.normal_force / fine.normal_force, 1.0, 1e-3);
  options.elements.across_narrowest = 28;
  options.elements.most = 1200;
  const LoadedContact coarse = loaded_contact(s1002_on_60e1(), pose, options);
  EXPECT_LE(coarse.elements.count(), 1200);
  EXPECT_LT(coarse.rows_across_peak, 8.0) << "what is not resolved is said";
}

// p ≥ 0, gap ≥ 0, p gap = 0: from the direct sum.
TEST(LoadedContact, PressureAndGapExcludeEachOther) {
  LoadedContactOptions options;
  options.elements.across_narrowest = 14;
  options.tolerance.residual = 1e-10;
  const LoadedContact c = loaded_contact(s1002_on_60e1(), lowered(5e-3, 0.0, 0.012, 6e-5), options);
  ASSERT_TRUE(c.converged);
  EXPECT_GE(c.pressure.minCoeff(), 0.0);
  std::vector<double> angle;
  for (const SurfaceLine& line : c.elements.line) angle.push_back(line.angle);
  const Eigen::VectorXd gap =
      direct_influence({c.elements.nx, c.elements.ns, c.elements.dx, c.elements.ds}, angle, options.contact_modulus()) *
          c.pressure -
      c.elements.overlap;
  int pressed = 0;
  for (Eigen::Index k = 0; k < gap.size(); ++k) {
    if (c.pressure[k] > 0.0) {
      EXPECT_LT(std::abs(gap[k]), 1e-12);
      ++pressed;
    } else {
      EXPECT_GT(gap[k], -1e-12);
    }
  }
  EXPECT_GT(pressed, 40);
}

// Without friction the force on the rail is the gradient of the elastic energy over the wheelset's motions; the energy
// ½ ∫ p h knows nothing of how the force is summed.
TEST(LoadedContact, ForceIsTheGradientOfTheEnergy) {
  LoadedContactOptions options;
  options.elements.across_narrowest = 56;
  options.tolerance.residual = 1e-8;
  const WheelRailPair& pair = s1002_on_60e1().pair();
  for (const WheelsetPose& pose : {lowered(-4e-3, 1e-3, 0.004, 6e-5), lowered(1.5e-3, 0.0, 0.0, 5e-5),
                                   lowered(5.9e-3, 0.0, 0.01, 1.5e-4), lowered(7.2e-3, 5e-4, -0.006, 1.5e-4)}) {
    const LoadedContact c = loaded_contact(s1002_on_60e1(), pose, options);
    const double step = 1e-6, turn = 2e-6;
    const auto slope = [&](double WheelsetPose::*part, double by) {
      WheelsetPose ahead = pose, behind = pose;
      ahead.*part += by;
      behind.*part -= by;
      // same elements on both sides: their number must not change within the difference
      return (loaded_contact(s1002_on_60e1(), ahead, options).elastic_energy -
              loaded_contact(s1002_on_60e1(), behind, options).elastic_energy) /
             (2.0 * by);
    };
    const WheelsetCentre centre = wheelset_centre(pair, pose);
    const Eigen::Vector3d moment = c.on_rail.moment_about({0.0, centre.y, centre.z});
    const Eigen::Vector3d axis(0.0, -std::sin(pose.roll), std::cos(pose.roll));  // of yaw
    EXPECT_NEAR(slope(&WheelsetPose::z, step) / c.normal_force, c.on_rail.force.z() / c.normal_force, 3e-3);
    EXPECT_NEAR(slope(&WheelsetPose::y, step) / c.normal_force, c.on_rail.force.y() / c.normal_force, 3e-3);
    // arms of the normal force: 0.75 m, and x
    EXPECT_NEAR(slope(&WheelsetPose::roll, turn) / c.normal_force, moment.x() / c.normal_force, 2e-3);
    EXPECT_NEAR(slope(&WheelsetPose::yaw, 10 * turn) / c.normal_force, moment.dot(axis) / c.normal_force, 1e-4);
    EXPECT_EQ(c.on_rail.force.x(), 0.0);
  }
}

TEST(LoadedContact, BandsAddUpToTheWhole) {
  const LoadedContact c = loaded_contact(s1002_on_60e1(), lowered(5e-3, -1e-4, 0.012, 8e-5));
  ASSERT_EQ(c.bands.size(), 2u);
  Eigen::Vector3d force = Eigen::Vector3d::Zero();
  double normal = 0.0, area = 0.0;
  int elements = 0;
  for (const ContactBand& band : c.bands) {
    force += band.force;
    normal += band.normal_force;
    area += band.area;
    elements += band.elements;
    EXPECT_LE(band.largest_pressure, c.largest_pressure);
    EXPECT_GT(band.s_rail, band.s_low);
    EXPECT_LT(band.s_rail, band.s_high);
    EXPECT_NEAR(std::numbers::pi * band.a * band.b / band.area, 1.0, 0.2);  // an ellipse's would be 1
  }
  EXPECT_LT(c.bands[0].s_high, c.bands[1].s_low);
  EXPECT_LT(c.bands[0].angle, c.bands[1].angle);
  EXPECT_LT((force - c.on_rail.force).norm(), 1e-9 * normal);
  EXPECT_NEAR(normal / c.normal_force, 1.0, 1e-12);
  EXPECT_NEAR(area / c.area, 1.0, 1e-12);
  EXPECT_EQ(elements, static_cast<int>((c.pressure.array() > 0.0).count()));
}

TEST(LoadedContact, ForceIsProportionalToTheContactModulus) {
  LoadedContactOptions steel, other;
  other.wheel = {70e9, 0.33};
  other.rail = {150e9, 0.2};
  const WheelsetPose pose = lowered(2e-3, 0.0, 0.0, 4e-5);
  const double expected = other.contact_modulus() / steel.contact_modulus();
  EXPECT_NEAR(1.0 / other.contact_modulus(), (1 - 0.33 * 0.33) / 70e9 + (1 - 0.04) / 150e9, 1e-24);
  EXPECT_NEAR(steel.contact_modulus(), ElasticMaterial{}.contact_modulus(), 1.0);
  EXPECT_NEAR(loaded_contact(s1002_on_60e1(), pose, other).normal_force /
                  loaded_contact(s1002_on_60e1(), pose, steel).normal_force,
              expected, 1e-5 * expected);
}

TEST(LoadedContact, CarriesTheLoad) {
  for (const double load : {10.0, 1e3, 75e3}) {
    for (const double y : {-6e-3, 0.25e-3, 5e-3, 7e-3}) {
      const ContactAtLoad found = contact_at_load(s1002_on_60e1(), {y, 0.0, 0.0, 2.4 * y}, load);
      EXPECT_TRUE(found.converged) << load << " N at " << y;
      EXPECT_NEAR(found.vertical_force / load, 1.0, 1e-5);
      EXPECT_NEAR(found.contact.on_rail.force.z() / load, 1.0, 1e-5);
      EXPECT_LE(found.evaluations, 8);
    }
  }
}

TEST(LoadedContact, NothingTouchesAboveFirstTouch) {
  const LoadedContact c = loaded_contact(s1002_on_60e1(), lowered(1e-3, 0.0, 0.0, -1e-6));
  EXPECT_TRUE(c.converged);
  EXPECT_TRUE(c.bands.empty());
  EXPECT_EQ(c.normal_force, 0.0);
  EXPECT_EQ(c.on_rail.force.norm(), 0.0);
}

TEST(LoadedContact, RejectsWhatItCannotDo) {
  LoadedContactOptions options;
  options.elements.most = 100;
  EXPECT_THROW(static_cast<void>(loaded_contact(s1002_on_60e1(), lowered(0.0, 0.0, 0.0, 5e-5), options)),
               TooManyElements);
  options.elements.most = 99999999;
  EXPECT_THROW(options.validate(), InputError);
  options = {};
  options.wheel.nu = 0.7;
  EXPECT_THROW(static_cast<void>(loaded_contact(s1002_on_60e1(), {}, options)), InputError);
  EXPECT_THROW(static_cast<void>(contact_at_load(s1002_on_60e1(), {}, 0.0)), InputError);
  EXPECT_THROW(static_cast<void>(contact_at_load(s1002_on_60e1(), {0.2, 0.0, 0.0, 0.0}, 1e4)), InputError);
}

}  // namespace
}  // namespace railtab
