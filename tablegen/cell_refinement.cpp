#include "railtab/tablegen/cell_refinement.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "railtab/runtime/contact/table_contact.hpp"
#include "railtab/tablegen/even_points.hpp"
#include "railtab/tablegen/geometry_parts.hpp"

namespace railtab {

namespace {

/// A limit found at a few points holds for the whole leaf only with some room below it [m].
constexpr double limit_margin = 20e-6;
/// Table and online search agree where their pairs are this near along the wheel [m].
constexpr double same_pair = 5e-6;
/// A patch shallower than this may be on one side only [m].
constexpr double grazing = 1e-8;
constexpr int inside_checks = 16;       ///< points inside every cell
constexpr int last_inside_checks = 64;  ///< points inside a leaf that is not perfect, for its limit
constexpr int outline_checks = 4;       ///< points inside every leaf, against the outlines' exact overlap

std::array<double, 4> check_point(int n) { return even_point(0.5, n + 1); }

/// Height at which a wheel first touches on a branch of the leaf; infinite without one [m].
double first_touch_of(const GeometryLeaf& leaf) {
  double first = std::numeric_limits<double>::infinity();
  for (int n = 0; n < leaf.count; ++n) first = std::min(first, leaf.start(n, 0.0).z_touch);
  return first;
}

}  // namespace

struct CellRefinement::Trial {
  int branches = 0;
  std::vector<float> coefficient;
  double trusted_lowering = 0;
  int checks = 0;
  int searched = 0;        ///< checks at which a start would lead nowhere
  int wrong = 0;           ///< checks at which the patches differ
  double start_error = 0;  ///< largest, along the wheel [m]
  bool empty = false;      ///< the wheel meets the rail nowhere
  std::size_t axis = 0;    ///< to be halved if any

  [[nodiscard]] double failing() const { return checks == 0 ? 1.0 : static_cast<double>(searched + wrong) / checks; }
};

CellRefinement::CellRefinement(const ContactSearch& search, const GeometrySweepOptions& options)
    : search_(search),
      options_(options),
      outlines_(search.pair()),
      radius_(search.pair().nominal_radius()),
      yaw_axis_(options.yaw.low < options.yaw.high),
      roll_axis_(options.roll.low < options.roll.high) {}

CellTree CellRefinement::tree(const CellBox& root) const {
  CellTree tree;
  tree.node.push_back(0);
  refine(root, 0, tree);
  return tree;
}

/// The sheared axis reaches further than the lateral shift that the table is asked for.
bool CellRefinement::in_range(const CellBox& box) const {
  const double least = box.low[0] + radius_ * box.low[2];
  const double most = box.high[0] + radius_ * box.high[2];
  return most >= options_.lateral.low && least <= options_.lateral.high;
}

/// Share of the box in queries uniform over lateral shift, yaw and roll.
double CellRefinement::share_of_queries(const CellBox& box) const {
  double share = (box.high[0] - box.low[0]) / (options_.lateral.high - options_.lateral.low);
  if (yaw_axis_) {
    const Interval yaw = options_.yaw_amounts();
    share *= (std::sqrt(box.high[1]) - std::sqrt(box.low[1])) / (yaw.high - yaw.low);
  }
  if (roll_axis_) share *= (box.high[2] - box.low[2]) / (options_.roll.high - options_.roll.low);
  return share;
}

void CellRefinement::refine(const CellBox& box, std::size_t node, CellTree& tree) const {
  const double share = share_of_queries(box);
  Trial trial;
  if (!in_range(box)) {
    trial.empty = true;
  } else {
    trial = attempt(box, share);
    bool halve = !trial.empty && (trial.failing() * share > options_.fallback_cell ||
                                  (trial.start_error > options_.start_error && share > options_.iterated_cell));
    if (!halve && !trial.empty) {
      const int wrong = trial.wrong;
      check_outlines(box, trial);
      halve = trial.wrong > wrong && share > options_.fallback_cell;
    }
    if (halve) {
      const auto lower = static_cast<std::uint32_t>(tree.node.size());
      tree.node[node] = CellNode::halved(static_cast<std::uint32_t>(trial.axis), lower);
      tree.node.resize(tree.node.size() + 2);
      const double middle = box.at(trial.axis, 0.0);
      CellBox half = box;
      half.high[trial.axis] = middle;
      refine(half, lower, tree);
      half.high[trial.axis] = box.high[trial.axis];
      half.low[trial.axis] = middle;
      refine(half, lower + 1, tree);
      return;
    }
    if (trial.searched + trial.wrong > 0) check_inside(box, inside_checks, last_inside_checks, trial);
  }
  tree.node[node] = CellNode::leaf(static_cast<std::uint32_t>(tree.leaf_branch.size()));
  tree.leaf_branch.push_back(static_cast<std::uint32_t>(trial.branches));
  tree.trusted_lowering.push_back(static_cast<float>(std::max(0.0, trial.trusted_lowering)));
  tree.coefficient.insert(tree.coefficient.end(), trial.coefficient.begin(), trial.coefficient.end());
}

CellRefinement::Trial CellRefinement::attempt(const CellBox& box, double share) const {
  Trial trial;
  const BoxSamples samples(search_, box, options_.searched_lowering);
  if (!samples.touches_everywhere()) {
    trial.empty = samples.samples().size() == 1 || share < options_.iterated_cell;
    return trial;
  }
  trial.trusted_lowering = options_.searched_lowering;
  const int terms = branch_terms(yaw_axis_, roll_axis_);
  if (samples.missing_height() < trial.trusted_lowering) trial.trusted_lowering = samples.missing_height();
  for (const SampledBranch& branch : samples.branches()) {
    const auto fitted = fit_branch(branch, yaw_axis_, roll_axis_);
    trial.coefficient.insert(trial.coefficient.end(), fitted.begin(), fitted.begin() + terms * branch_quantities);
    ++trial.branches;
  }
  check_samples(box, samples, trial);
  // Where much is wrong already, the cell will be halved whatever the points inside say.
  if (trial.failing() * share < 20 * options_.fallback_cell) check_inside(box, 0, inside_checks, trial);
  trial.axis = axis_to_halve(samples, trial);
  return trial;
}

void CellRefinement::check_samples(const CellBox& box, const BoxSamples& samples, Trial& trial) const {
  for (const BoxSample& s : samples.samples()) {
    WheelsetPose pose = s.pose;
    pose.z += options_.searched_lowering;
    check_pose(box, s.local, pose, s.lowered, trial);
  }
}

void CellRefinement::check_inside(const CellBox& box, int first, int end, Trial& trial) const {
  for (int n = first; n < end; ++n) {
    const std::array<double, 4> fraction = check_point(n);
    std::array<double, 3> local{};
    for (std::size_t a = 0; a < 3; ++a) local[a] = axis_fixed(a) ? 0.0 : 2.0 * fraction[a] - 1.0;
    WheelsetPose pose = pose_in(box, local, radius_);
    pose.z = search_.touch_height(pose.y, pose.roll, pose.yaw) + fraction[3] * options_.searched_lowering;
    if (std::isfinite(pose.z)) check_pose(box, local, pose, search_.patches(pose), trial);
  }
}

/// The patches that the runtime would find from this leaf, against the exact overlap. Every other pose is as deep as
/// the leaf is trusted, where most contacts exist.
void CellRefinement::check_outlines(const CellBox& box, Trial& trial) const {
  for (int n = 0; n < outline_checks; ++n) {
    const std::array<double, 4> fraction = check_point(last_inside_checks + n);
    std::array<double, 3> local{};
    for (std::size_t a = 0; a < 3; ++a) local[a] = axis_fixed(a) ? 0.0 : 2.0 * fraction[a] - 1.0;
    const GeometryLeaf leaf = leaf_at(box, local, trial);
    WheelsetPose pose = pose_in(box, local, radius_);
    const double first_touch = first_touch_of(leaf);
    pose.z = first_touch + (n % 2 == 0 ? 1.0 : fraction[3]) * trial.trusted_lowering;
    ContactPatches patches;
    if (!std::isfinite(pose.z) || add_branch_patches(search_, leaf, pose, pose.z, 0.0, patches) == TableAnswer::none) {
      continue;
    }
    ++trial.checks;
    const RegionComparison comparison = compare(outlines_.regions(pose), patches);
    if (!comparison.mismatch) continue;
    ++trial.wrong;
    trial.trusted_lowering = std::min(trial.trusted_lowering, pose.z - first_touch - comparison.height - limit_margin);
  }
}

/// As the runtime would look it up, however far it is to be trusted.
GeometryLeaf CellRefinement::leaf_at(const CellBox& box, const std::array<double, 3>& local, const Trial& trial) const {
  GeometryLeaf leaf;
  leaf.coefficient = trial.coefficient.data();
  leaf.count = trial.branches;
  leaf.terms = branch_terms(yaw_axis_, roll_axis_);
  leaf.point = {static_cast<float>(local[0]), static_cast<float>(local[yaw_axis_ ? 1 : 2]),
                static_cast<float>(local[2])};
  leaf.per_metre = static_cast<float>(2.0 / (box.high[0] - box.low[0]));
  leaf.trusted_lowering = std::numeric_limits<float>::infinity();
  return leaf;
}

/// What the runtime would answer from this leaf, against the online search's answer.
void CellRefinement::check_pose(const CellBox& box, const std::array<double, 3>& local, const WheelsetPose& pose,
                                const ContactPatches& online, Trial& trial) const {
  ++trial.checks;
  const GeometryLeaf leaf = leaf_at(box, local, trial);
  const double first_touch = first_touch_of(leaf);
  ContactPatches table;
  const TableAnswer answer = add_branch_patches(search_, leaf, pose, pose.z, 0.0, table);
  trial.searched += static_cast<int>(answer != TableAnswer::looked_up);
  if (answer == TableAnswer::none) {  // the runtime searches the whole wheel
    ++trial.wrong;
    return;
  }
  bool wrong = false;
  const auto missing = [&](const ContactPatches& from, const ContactPatches& in) {
    for (const ContactPatch& p : from) {
      const bool found = std::any_of(
          in.begin(), in.end(), [&](const ContactPatch& q) { return std::abs(p.s_wheel - q.s_wheel) < same_pair; });
      if (found || p.penetration < grazing) continue;
      wrong = true;
      const double height = pose.z - first_touch - p.penetration / std::cos(p.angle);
      trial.trusted_lowering = std::min(trial.trusted_lowering, height - limit_margin);
    }
  };
  missing(online, table);
  missing(table, online);
  trial.wrong += wrong;
  for (int n = 0; n < leaf.count; ++n) {
    const BranchStart start = leaf.start(n, pose.z);
    if (start.z_touch >= pose.z) continue;
    double nearest = std::numeric_limits<double>::infinity();
    for (const ContactPatch& p : table) nearest = std::min(nearest, std::abs(p.s_wheel - start.s_wheel));
    if (std::isfinite(nearest)) trial.start_error = std::max(trial.start_error, nearest);
  }
}

namespace {

std::size_t largest(const std::array<double, 3>& values) {
  return static_cast<std::size_t>(std::max_element(values.begin(), values.end()) - values.begin());
}

}  // namespace

/// Along which a branch begins or ends the most; else along which the polynomials' errors differ the most between
/// neighbours; else, where the samples lie on the polynomials, along which s_wheel bends the most.
std::size_t CellRefinement::axis_to_halve(const BoxSamples& samples, const Trial& trial) const {
  const std::array<double, 3> changes = samples.changes();
  if (trial.searched + trial.wrong > 0 && changes[largest(changes)] > 0) return largest(changes);
  std::array<double, 3> error{}, bend{};
  const int terms = branch_terms(yaw_axis_, roll_axis_);
  const std::vector<BoxSample>& all = samples.samples();
  for (int b = 0; b < trial.branches; ++b) {
    const SampledBranch& branch = samples.branches()[static_cast<std::size_t>(b)];
    // The data begin with the touches of the samples at which the branch exists, in their order.
    std::vector<double> residual(all.size()), s_wheel(all.size());
    std::size_t next = 0;
    for (std::size_t n = 0; n < all.size(); ++n) {
      if (!branch.at_sample[n]) continue;
      const BranchDatum& d = branch.data[next++];
      const auto m = branch_monomials(yaw_axis_, roll_axis_, d.local[0], d.local[1], d.local[2]);
      double fitted = 0;
      for (int t = 0; t < terms; ++t) {
        const int place = (b * terms + t) * branch_quantities + 1;
        fitted +=
            static_cast<double>(trial.coefficient[static_cast<std::size_t>(place)]) * m[static_cast<std::size_t>(t)];
      }
      residual[n] = fitted - d.s_wheel;
      s_wheel[n] = d.s_wheel;
    }
    for (std::size_t axis = 0; axis < 3; ++axis) {
      samples.for_each_neighbours(axis, [&](std::size_t p, std::size_t q) {
        if (!branch.at_sample[p] || !branch.at_sample[q]) return;
        error[axis] = std::max(error[axis], std::abs(residual[p] - residual[q]));
        const std::size_t o = 2 * p - q;
        if (all[q].grid[axis] < 2 || !branch.at_sample[o]) return;
        bend[axis] = std::max(bend[axis], std::abs(s_wheel[q] - 2 * s_wheel[p] + s_wheel[o]));
      });
    }
  }
  if (error[largest(error)] > 0.25 * trial.start_error) return largest(error);
  bend[0] *= 4.0;  // over half the box, as the other axes
  return largest(bend);
}

}  // namespace railtab
