#include "railtab/tablegen/leaf_branches.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "railtab/runtime/base/dense_solvers.hpp"

namespace railtab {

namespace {

/// Samples stand a little outside the box, so that its faces are inside what was sampled.
constexpr double enlarged = 1.001;
/// Minima up to this height above first touch are linked [m]: more than touch, so that none seems to end at the limit.
constexpr double linked_height = 1e-3;
/// Branches that come this near to touching count [m].
constexpr double touching_margin = 20e-6;
/// Cost of leaving a minimum without a partner when lists of minima are aligned [m].
constexpr double gap_cost = 1e-3;
/// Two solutions of the touch equations nearer than this are one [m].
constexpr double same_touch = 1e-7;

}  // namespace

BoxSamples::BoxSamples(const ContactSearch& search, const CellBox& box, double lowering)
    : box_(box), lowering_(lowering), radius_(search.pair().nominal_radius()) {
  size_ = {5, box.fixed(1) ? 1U : 3U, box.fixed(2) ? 1U : 3U};
  stride_ = {1, size_[0], size_[0] * size_[1]};
  search_samples(search);
  if (!touches_everywhere_) return;
  link_touches();
  follow_lowered(search);
  collect();
}

void BoxSamples::search_samples(const ContactSearch& search) {
  const auto local = [&](std::size_t axis, std::size_t n) {
    return size_[axis] == 1 ? 0.0
                            : enlarged * (2.0 * static_cast<double>(n) / static_cast<double>(size_[axis] - 1) - 1.0);
  };
  for (std::size_t k = 0; k < size_[2]; ++k)
    for (std::size_t j = 0; j < size_[1]; ++j)
      for (std::size_t i = 0; i < size_[0]; ++i) {
        BoxSample& s = samples_.emplace_back();
        s.local = {local(0, i), local(1, j), local(2, k)};
        s.grid = {static_cast<int>(i), static_cast<int>(j), static_cast<int>(k)};
        s.pose.roll = box_.at(2, s.local[2]);
        s.pose.yaw = std::sqrt(std::max(0.0, box_.at(1, s.local[1])));
        s.pose.y = box_.at(0, s.local[0]) + radius_ * s.pose.roll;
        s.touches = search.touches(s.pose.y, s.pose.roll, s.pose.yaw, linked_height);
        s.pose.z = std::numeric_limits<double>::quiet_NaN();
        for (const TouchPoint& t : s.touches) {
          if (!(t.z_touch >= s.pose.z)) s.pose.z = t.z_touch;
        }
        if (s.touches.count == 0) {
          touches_everywhere_ = false;
          return;
        }
        WheelsetPose lowered = s.pose;
        lowered.z += lowering_;
        s.lowered = search.patches(lowered);
      }
}

namespace {

/// Which minima of two neighbouring samples continue each other: the alignment of both lists, in order along the wheel,
/// of least cost. A pair costs the difference of the arc lengths that both predict half-way.
void align(const TouchPoints& p, const TouchPoints& q, double dy, std::vector<std::pair<int, int>>& pairs) {
  enum class Last : std::uint8_t { pair, gap_in_q, gap_in_p };
  constexpr std::size_t size = TouchPoints::capacity + 1;
  std::array<std::array<double, size>, size> cost;
  std::array<std::array<Last, size>, size> last;
  for (int i = 0; i <= p.count; ++i)
    for (int j = 0; j <= q.count; ++j) {
      if (i == 0 || j == 0) {
        cost[i][j] = gap_cost * (i + j);
        continue;
      }
      const TouchPoint& s = p.touch[i - 1];
      const TouchPoint& t = q.touch[j - 1];
      const double difference = std::abs(t.s_wheel - s.s_wheel - 0.5 * dy * (s.s_wheel_dy + t.s_wheel_dy));
      const std::array<double, 3> choice{cost[i - 1][j - 1] + difference, cost[i - 1][j] + gap_cost,
                                         cost[i][j - 1] + gap_cost};
      const auto best = std::min_element(choice.begin(), choice.end());
      cost[i][j] = *best;
      last[i][j] = static_cast<Last>(best - choice.begin());
    }
  pairs.clear();
  for (int i = p.count, j = q.count; i > 0 && j > 0;) {
    const Last choice = last[i][j];
    if (choice != Last::gap_in_p) --i;
    if (choice != Last::gap_in_q) --j;
    if (choice == Last::pair) pairs.emplace_back(i, j);
  }
}

}  // namespace

namespace {

/// Sets of minima that continue each other: union-find, with the samples at which each set has one.
class LinkedMinima {
 public:
  int add(std::size_t sample) {
    parent_.push_back(static_cast<int>(parent_.size()));
    samples_.push_back(std::uint64_t{1} << sample);
    return parent_.back();
  }
  int root(int n) {
    while (parent_[static_cast<std::size_t>(n)] != n) {
      int& up = parent_[static_cast<std::size_t>(n)];
      n = up = parent_[static_cast<std::size_t>(up)];
    }
    return n;
  }
  /// Rejected where the union would have two minima at one sample.
  void link(int p, int q) {
    const auto i = static_cast<std::size_t>(root(p));
    const auto j = static_cast<std::size_t>(root(q));
    if (i == j || (samples_[i] & samples_[j]) != 0) return;
    parent_[j] = static_cast<int>(i);
    samples_[i] |= samples_[j];
  }
  [[nodiscard]] int size() const { return static_cast<int>(parent_.size()); }

 private:
  std::vector<int> parent_;
  std::vector<std::uint64_t> samples_;
};

}  // namespace

/// Neighbours along the lateral axis first: with the exact derivatives along it they are the surest.
void BoxSamples::link_touches() {
  LinkedMinima minima;
  for (std::size_t n = 0; n < samples_.size(); ++n) {
    for (int i = 0; i < samples_[n].touches.count; ++i) samples_[n].component[i] = minima.add(n);
  }
  std::vector<std::pair<int, int>> pairs;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    for_each_neighbours(axis, [&](std::size_t p, std::size_t q) {
      const double dy = axis == 0 ? samples_[q].pose.y - samples_[p].pose.y : 0.0;
      align(samples_[p].touches, samples_[q].touches, dy, pairs);
      for (const auto& [i, j] : pairs) minima.link(samples_[p].component[i], samples_[q].component[j]);
    });
  }
  std::vector<int> number(static_cast<std::size_t>(minima.size()), -1);
  for (BoxSample& s : samples_) {
    for (int i = 0; i < s.touches.count; ++i) {
      int& component = number[static_cast<std::size_t>(minima.root(s.component[i]))];
      if (component < 0) component = components_++;
      s.component[i] = component;
    }
  }
}

BranchDatum BoxSamples::datum(const BoxSample& sample, double y, double z, double slope, double s_wheel,
                              double s_rail) const {
  BranchDatum d;
  d.local = sample.local;
  const double half = 0.5 * (box_.high[0] - box_.low[0]);
  d.local[0] += (y - sample.pose.y) / half;
  d.z = z;
  d.s_wheel = s_wheel;
  d.s_rail = s_rail;
  d.normal_product = -slope / (1.0 + slope * slope);
  return d;
}

/// A patch of a lowered wheel is a touch beside: from there the branch is followed back to the touch at the sample.
void BoxSamples::follow_lowered(const ContactSearch& search) {
  lowered_data_.resize(static_cast<std::size_t>(components_));
  const double half = 0.5 * (box_.high[0] - box_.low[0]);
  std::vector<std::vector<BranchDatum>> orphans;
  for (BoxSample& s : samples_) {
    const PoseTrigonometry trig(s.pose);
    for (int n = 0; n < s.lowered.count; ++n) {
      const ContactPatch& patch = s.lowered.patch[n];
      const double shift = patch.penetration * std::sin(patch.angle);  // y* - y = -d n_y
      const double z = s.pose.z + lowering_ - patch.penetration * std::cos(patch.angle);
      std::vector<BranchDatum> way{datum(s, s.pose.y + shift, z, std::tan(patch.angle), patch.s_wheel, patch.s_rail)};
      const int steps = static_cast<int>(std::clamp(std::ceil(std::abs(shift) / half), 1.0, 4.0));
      TouchPoint touch = touch_of_pair(search.pair(), {s.pose.y + shift, 0, s.pose.roll, s.pose.yaw}, trig,
                                       {patch.s_wheel, patch.s_rail});
      bool followed = true;
      for (int k = steps - 1; k >= 0 && followed; --k) {
        const double y = s.pose.y + shift * k / steps;
        const double dy = -shift / steps;
        const RefinedTouch r =
            refine_touch(search.pair(), {y, 0, s.pose.roll, s.pose.yaw}, trig,
                         {touch.s_wheel + dy * touch.s_wheel_dy, touch.s_rail + dy * touch.s_rail_dy});
        followed = r.status == PairStatus::converged;
        touch = r.touch;
        if (followed && k > 0) way.push_back(datum(s, y, touch.z_touch, touch.z_touch_dy, touch.s_wheel, touch.s_rail));
      }
      int component = -1;  // branch of the patch
      for (int t = 0; followed && t < s.touches.count; ++t) {
        if (std::abs(s.touches.touch[t].s_wheel - touch.s_wheel) < same_touch) component = s.component[t];
      }
      if (component < 0) {
        orphans.push_back(std::move(way));
        continue;
      }
      auto& data = lowered_data_[static_cast<std::size_t>(component)];
      data.insert(data.end(), way.begin(), way.end());
    }
  }
  adopt(orphans);
}

/// Patches of a lowered wheel whose branch ends before it comes to the touch at their own sample: they belong to the
/// branch whose touches are nearest on the wheel, or are one of their own.
void BoxSamples::adopt(const std::vector<std::vector<BranchDatum>>& orphans) {
  constexpr double nearest_touch = 0.3e-3;  // [m]
  for (const std::vector<BranchDatum>& orphan : orphans) {
    const double s_wheel = orphan.back().s_wheel;
    double nearest = nearest_touch;
    int own = -1;
    const auto offer = [&](int component, double s) {
      if (std::abs(s - s_wheel) >= nearest) return;
      nearest = std::abs(s - s_wheel);
      own = component;
    };
    for (const BoxSample& s : samples_) {
      for (int t = 0; t < s.touches.count; ++t) offer(s.component[t], s.touches.touch[t].s_wheel);
    }
    for (int c = 0; c < components_; ++c) {
      for (const BranchDatum& d : lowered_data_[static_cast<std::size_t>(c)]) offer(c, d.s_wheel);
    }
    if (own < 0) {
      own = components_++;
      lowered_data_.emplace_back();
    }
    auto& data = lowered_data_[static_cast<std::size_t>(own)];
    data.insert(data.end(), orphan.begin(), orphan.end());
  }
}

/// The components that can touch, each with all its data.
void BoxSamples::collect() {
  std::vector<SampledBranch> all(static_cast<std::size_t>(components_));
  for (SampledBranch& b : all) {
    b.at_sample.assign(samples_.size(), false);
    b.least_height = std::numeric_limits<double>::infinity();
  }
  for (std::size_t n = 0; n < samples_.size(); ++n) {
    const BoxSample& s = samples_[n];
    for (int i = 0; i < s.touches.count; ++i) {
      SampledBranch& b = all[static_cast<std::size_t>(s.component[i])];
      const TouchPoint& t = s.touches.touch[i];
      b.at_sample[n] = true;
      b.least_height = std::min(b.least_height, t.z_touch - s.pose.z);
      b.data.push_back(datum(s, s.pose.y, t.z_touch, t.z_touch_dy, t.s_wheel, t.s_rail));
    }
  }
  for (std::size_t c = 0; c < all.size(); ++c) {
    SampledBranch& b = all[c];
    // A patch at the largest lowering touches at a lower one, how much lower is not asked here.
    if (!lowered_data_[c].empty()) b.least_height = std::min(b.least_height, lowering_);
    if (b.least_height > lowering_ + touching_margin) continue;
    b.data.insert(b.data.end(), lowered_data_[c].begin(), lowered_data_[c].end());
    branches_.push_back(std::move(b));
  }
  const auto lower = [](const SampledBranch& p, const SampledBranch& q) { return p.least_height < q.least_height; };
  std::sort(branches_.begin(), branches_.end(), lower);
  if (branches_.size() > GeometryTable::max_branches) {
    missing_height_ = branches_[GeometryTable::max_branches].least_height - touching_margin;
    branches_.resize(GeometryTable::max_branches);
  }
  const auto inner = [](const SampledBranch& p, const SampledBranch& q) {
    return p.data.front().s_rail < q.data.front().s_rail;
  };
  std::sort(branches_.begin(), branches_.end(), inner);
}

std::array<double, 3> BoxSamples::changes() const {
  std::array<double, 3> share{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    int changed = 0;
    int pairs = 0;
    for_each_neighbours(axis, [&](std::size_t p, std::size_t q) {
      ++pairs;
      changed += std::any_of(branches_.begin(), branches_.end(),
                             [&](const SampledBranch& b) { return b.at_sample[p] != b.at_sample[q]; });
    });
    // Per unit of the box, not of the neighbours' distance.
    if (pairs > 0) share[axis] = static_cast<double>(changed) / pairs * static_cast<double>(size_[axis] - 1);
  }
  return share;
}

std::array<float, most_branch_terms * branch_quantities> fit_branch(const SampledBranch& branch, bool yaw_axis,
                                                                    bool roll_axis) {
  // Where there are fewer data than terms, the higher terms are held small: weight against data of 1 [-].
  constexpr double small = 1e-5;
  const int terms = branch_terms(yaw_axis, roll_axis);
  const auto rows = static_cast<Eigen::Index>(branch.data.size());
  Eigen::MatrixXd A = Eigen::MatrixXd::Zero(rows + terms, terms);
  Eigen::MatrixXd B = Eigen::MatrixXd::Zero(rows + terms, branch_quantities);
  for (Eigen::Index n = 0; n < rows; ++n) {
    const BranchDatum& d = branch.data[static_cast<std::size_t>(n)];
    const auto m = branch_monomials(yaw_axis, roll_axis, d.local[0], d.local[1], d.local[2]);
    for (int t = 0; t < terms; ++t) A(n, t) = m[static_cast<std::size_t>(t)];
    B.row(n) << d.z, d.s_wheel, d.s_rail, d.normal_product;
  }
  const Eigen::RowVectorXd origin = B.topRows(rows).colwise().mean();
  B.topRows(rows).rowwise() -= origin;
  const Eigen::VectorXd scale = A.colwise().norm().cwiseMax(1e-3).transpose();
  A = A * scale.cwiseInverse().asDiagonal();
  for (int t = 1; t < terms; ++t) A(rows + t, t) = small;
  const Eigen::MatrixXd X = scale.cwiseInverse().asDiagonal() * least_squares_solution(A, B);
  std::array<float, most_branch_terms * branch_quantities> coefficient{};
  for (int t = 0; t < terms; ++t)
    for (int q = 0; q < branch_quantities; ++q) {
      coefficient[static_cast<std::size_t>(t * branch_quantities + q)] =
          static_cast<float>(X(t, q) + (t == 0 ? origin(q) : 0.0));
    }
  return coefficient;
}

}  // namespace railtab
