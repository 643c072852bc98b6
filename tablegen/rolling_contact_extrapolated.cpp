#include <fmt/format.h>

#include "railtab/runtime/base/input_error.hpp"
#include "railtab/tablegen/rolling_contact.hpp"

namespace railtab {

namespace {

RollingContactOptions equal_area(RollingContactOptions options, int divisor) {
  if (options.elements < 8 || options.elements % 2 != 0) {
    throw input_error("elements", fmt::format("{}", options.elements), "an even number, at least 8");
  }
  options.elements /= divisor;
  options.size = RollingContactOptions::ElementSize::equal_area;
  options.direction = RollingContactOptions::SlipDirection::averaged;
  return options;
}

}  // namespace

ExtrapolatedRollingContact::ExtrapolatedRollingContact(double ratio, double nu, const RollingContactOptions& options)
    : coarse_(ratio, nu, equal_area(options, 2)), fine_(ratio, nu, equal_area(options, 1)) {}

ExtrapolatedContactSolution ExtrapolatedRollingContact::solve(const Creepage& creepage,
                                                              const std::vector<double>* coarse_start) {
  ExtrapolatedContactSolution s;
  s.coarse = coarse_.solve(creepage, coarse_start);
  const std::vector<double> start = fine_.refined(s.coarse.traction);
  s.fine = fine_.solve(creepage, &start);
  for (const auto part : {&CreepForce::x, &CreepForce::y, &CreepForce::moment}) {
    s.force.*part = 2.0 * s.fine.force.*part - s.coarse.force.*part;
  }
  return s;
}

}  // namespace railtab
