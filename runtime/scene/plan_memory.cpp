#include "railtab/runtime/scene/plan_memory.hpp"

#include <algorithm>

#include "railtab/runtime/vsi/structure_response.hpp"

namespace railtab {

namespace {

constexpr double low_factor = 3.0;  // the factor for compliances, of the one for the steps

template <class Matrix>
double bytes_of(const Matrix& matrix) {
  return static_cast<double>(matrix.nonZeros()) * (sizeof(double) + sizeof(int)) +
         static_cast<double>(matrix.outerSize()) * sizeof(int);
}

}  // namespace

double step_memory(const VsiModel& model, double time_step, double alpha) {
  constexpr double vehicle_matrices = 6.0;  // M, C, K, gyroscopic, and for the step C with it and the inverse
  const double n = model.vehicle.dofs();
  double bytes = vehicle_matrices * n * n * sizeof(double);
  if (!model.structure) return bytes;
  const StructureModel& s = *model.structure;
  for (const auto* matrix : {&s.mass, &s.damping, &s.stiffness}) bytes += bytes_of(*matrix);
  for (const auto* columns : {&s.supports.mass, &s.supports.damping, &s.supports.stiffness, &s.supports.carried})
    bytes += bytes_of(*columns);
  const StructureResponse response(s, HhtScheme{.alpha = alpha, .time_step = time_step});
  bytes += (1.0 + low_factor) * static_cast<double>(response.factor().bytes());
  return bytes + static_cast<double>(response.load_bytes());
}

}  // namespace railtab
