#include "railtab/runtime/stability/branch_folds.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

namespace railtab {

namespace {

constexpr int most_refinements = 30;   // of a bracket
constexpr double least_shrink = 0.05;  // of a step where none longer finds a motion

// How far apart the parameters of two motions are for certain.
double uncertainty(const BranchCycle& a, const BranchCycle& b, const BranchSearch& search) {
  return std::max(search.parameter_tolerance, 2.0 * (a.parameter_error + b.parameter_error));
}

// Where between 0 and 1 the cubic with these values and slopes at its ends has an extremum beyond both by more than
// `least`; none unless a slope is against the way from end to end, which makes the extremum certain.
std::optional<double> overshoot(double from, double to, double slope_from, double slope_to, double least) {
  if (slope_from * (to - from) > 0.0 && slope_to * (to - from) > 0.0) return {};
  // p(t) = from + slope_from t + b t² + a t³
  const double a = slope_from + slope_to - 2.0 * (to - from), b = to - from - slope_from - a;
  const double root = std::sqrt(b * b - 3.0 * a * slope_from);  // NaN: monotone
  for (const double sign : {-1.0, 1.0}) {
    const double q = -(b + std::copysign(root, b));  // both roots of 3a t² + 2b t + slope_from without cancellation
    const double t = sign < 0.0 ? q / (3.0 * a) : slope_from / q;
    if (!(t > 0.0 && t < 1.0)) continue;
    const double p = from + t * (slope_from + t * (b + t * a));
    if (std::min(p - from, p - to) > least || std::min(from - p, to - p) > least) return t;
  }
  return {};
}

// Indices of the extrema between the ends from which the parameter departs for certain on both sides.
std::vector<std::size_t> certain_extrema(const std::vector<BranchCycle>& cycles, const BranchSearch& search) {
  std::vector<std::size_t> extrema;
  const auto parameter = [&](std::size_t i) { return cycles[i].motion.parameter; };
  std::size_t highest = 0, lowest = 0;  // since the last extremum
  int sense = 0;                        // of the parameter: +1 rises for certain, -1 falls
  for (std::size_t i = 1; i < cycles.size(); ++i) {
    if (parameter(i) > parameter(highest)) highest = i;
    if (parameter(i) < parameter(lowest)) lowest = i;
    const bool fell = parameter(highest) - parameter(i) > uncertainty(cycles[highest], cycles[i], search);
    const bool rose = parameter(i) - parameter(lowest) > uncertainty(cycles[i], cycles[lowest], search);
    if (sense >= 0 && fell) {
      if (sense > 0) extrema.push_back(highest);
      sense = -1;
      lowest = i;
    } else if (sense <= 0 && rose) {
      if (sense < 0) extrema.push_back(lowest);
      sense = 1;
      highest = i;
    }
  }
  return extrema;
}

class FoldSearch {
 public:
  FoldSearch(const Flow& flow, const CycleSection& section, const BranchSearch& search)
      : section_(section), search_(search), shooting_(flow, section, search.shooting) {}

  // Appends the motions between two neighbours that their tangents ask for, then `to`.
  // @param open  of cycles[i] and its successor: between them is an extremum, but no motion is found there
  void append(const BranchCycle& to, std::vector<BranchCycle>& cycles, std::vector<std::size_t>& open, int depth = 0) {
    constexpr int deepest = 4;
    const BranchCycle from = cycles.back();
    const BranchPoint way = chord(from, to);
    const double length = std::hypot(way.height, way.parameter);
    const auto t = overshoot(from.motion.parameter, to.motion.parameter, length * from.tangent.parameter,
                             length * to.tangent.parameter, uncertainty(from, to, search_));
    if (t && depth < deepest) {
      if (const auto found = between(from, to, *t, way)) {
        append(*found, cycles, open, depth + 1);
        append(to, cycles, open, depth + 1);
        return;
      }
      open.push_back(cycles.size() - 1);
    }
    cycles.push_back(to);
  }

  // Narrows the bracket of a fold whose cycle has the extreme parameter of the three.
  void locate(BranchFold& fold) {
    auto& [before, after] = fold.bracket;
    const BranchPoint direction = chord(before, after);
    double shrink = 1.0;  // of the next step, after motions that were not found
    for (int i = 0;; ++i) {
      fold.converged = departure(before, fold.cycle) < search_.parameter_tolerance &&
                       departure(after, fold.cycle) < search_.parameter_tolerance;
      if (fold.converged || i == most_refinements || shrink < least_shrink) return;
      const double left = place(before, fold.cycle, direction), right = place(after, fold.cycle, direction);
      if (!(left < 0.0 && right > 0.0)) return;  // the branch turns back across its chord
      const double next = shrink * next_place(fold, left, right);
      BranchCycle &near = next < 0.0 ? before : after, &far = next < 0.0 ? after : before;
      const auto found = between(fold.cycle, near, next / (next < 0.0 ? left : right), direction);
      if (!found) {
        shrink *= 0.5;
        continue;
      }
      shrink = 1.0;
      if (sense_of(fold) * (found->motion.parameter - fold.cycle.motion.parameter) > 0.0) {
        far = std::exchange(fold.cycle, *found);
      } else {
        near = *found;
      }
    }
  }

 private:
  // In units of the branch.
  [[nodiscard]] BranchPoint chord(const BranchCycle& from, const BranchCycle& to) const {
    const BranchPoint a = from.motion.point(section_), b = to.motion.point(section_);
    return {(b.height - a.height) / search_.unit.height, (b.parameter - a.parameter) / search_.unit.parameter};
  }

  // How far along a direction a motion is from another, in the direction's length.
  [[nodiscard]] double place(const BranchCycle& of, const BranchCycle& from, const BranchPoint& direction) const {
    const BranchPoint way = chord(from, of);
    return (way.height * direction.height + way.parameter * direction.parameter) /
           (direction.height * direction.height + direction.parameter * direction.parameter);
  }

  static double departure(const BranchCycle& end, const BranchCycle& extreme) {
    return std::abs(end.motion.parameter - extreme.motion.parameter);
  }

  // +1 for a maximum.
  static double sense_of(const BranchFold& fold) {
    const double ends = fold.bracket[0].motion.parameter + fold.bracket[1].motion.parameter;
    return 2.0 * fold.cycle.motion.parameter > ends ? 1.0 : -1.0;
  }

  // The next place to look at, with that of fold.cycle 0: the vertex of the parabola; once the motion is there, where
  // the parabola departs from it by half of the tolerance, on the side that is still farther.
  [[nodiscard]] double next_place(const BranchFold& fold, double left, double right) const {
    const double middle = fold.cycle.motion.parameter;
    const double by_left = (fold.bracket[0].motion.parameter - middle) / left;
    const double by_right = (fold.bracket[1].motion.parameter - middle) / right;
    const double bend = (by_right - by_left) / (right - left);
    const double vertex = -0.5 * (by_left - bend * left) / bend;
    const double close = std::sqrt(0.5 * search_.parameter_tolerance / std::abs(bend));
    double next = vertex;
    if (!(std::abs(vertex) > 0.5 * close)) {
      next = departure(fold.bracket[0], fold.cycle) > departure(fold.bracket[1], fold.cycle) ? -close : close;
    }
    if (next > 0.9 * left && next < 0.9 * right) return next;  // false for NaN
    return 0.5 * (-left > right ? left : right);
  }

  // The motion on the line across `direction` at a share of the way between two.
  std::optional<BranchCycle> between(const BranchCycle& from, const BranchCycle& to, double share,
                                     const BranchPoint& direction) {
    PeriodicMotion guess = from.motion;
    guess.start += share * (to.motion.start - from.motion.start);
    guess.period.duration += share * (to.motion.period.duration - from.motion.period.duration);
    guess.parameter += share * (to.motion.parameter - from.motion.parameter);
    const double length = std::hypot(direction.height, direction.parameter);
    const BranchLine across{
        guess.point(section_),
        {direction.height / (length * search_.unit.height), direction.parameter / (length * search_.unit.parameter)}};
    auto found = cycle_near(shooting_, section_, guess, across, search_);
    if (!found) return {};
    // The line may meet the branch elsewhere, too.
    const BranchPoint way = chord(from, *found), whole = chord(from, to);
    if (std::hypot(way.height, way.parameter) > 2.0 * std::hypot(whole.height, whole.parameter)) return {};
    const double along = found->tangent.start[section_.coordinate] / search_.unit.height * direction.height +
                         found->tangent.parameter / search_.unit.parameter * direction.parameter;
    if (along < 0.0) found->tangent.scale(-1.0);
    return found;
  }

  CycleSection section_;
  const BranchSearch& search_;
  Shooting shooting_;
};

}  // namespace

std::vector<BranchFold> branch_folds(const Flow& flow, const CycleSection& section, const CycleBranch& branch,
                                     const BranchSearch& search) {
  std::vector<BranchFold> result;
  if (branch.cycles.empty()) return result;
  FoldSearch folds(flow, section, search);
  std::vector<BranchCycle> cycles{branch.cycles.front()};
  std::vector<std::size_t> open;
  for (std::size_t i = 1; i < branch.cycles.size(); ++i) folds.append(branch.cycles[i], cycles, open);
  const std::vector<std::size_t> extrema = certain_extrema(cycles, search);
  const auto among = [](const std::vector<std::size_t>& places, std::size_t i) {
    return std::binary_search(places.begin(), places.end(), i);
  };
  for (std::size_t i = 0; i + 1 < cycles.size(); ++i) {
    if (among(extrema, i)) {
      BranchFold& fold = result.emplace_back(BranchFold{cycles[i], {cycles[i - 1], cycles[i + 1]}});
      folds.locate(fold);
    }
    if (among(open, i) && !among(extrema, i) && !among(extrema, i + 1)) {
      const bool rises = cycles[i].tangent.parameter > 0.0;  // to a maximum
      const bool first = (cycles[i].motion.parameter > cycles[i + 1].motion.parameter) == rises;
      result.push_back({cycles[first ? i : i + 1], {cycles[i], cycles[i + 1]}, false});
    }
  }
  return result;
}

}  // namespace railtab
