#include "railtab/runtime/structure/simple_beam.hpp"

#include <fmt/format.h>

#include "railtab/runtime/base/input_error.hpp"
#include "railtab/runtime/base/parameter_range.hpp"
#include "railtab/runtime/structure/beam_element.hpp"
#include "railtab/runtime/structure/matrix_assembly.hpp"

namespace railtab {

void SimpleBeamParameters::validate() const {
  require_positive("beam.length", length, "m");
  require_positive("beam.E", E, "Pa");
  require_positive("beam.I", I, "m⁴");
  require_positive("beam.mass", mass, "kg/m");
  if (elements < 2 || elements % 2 != 0) {
    throw input_error("beam.elements", fmt::format("{}", elements), "an even number, 2 or more");
  }
}

StructureModel build_simple_beam(const SimpleBeamParameters& p) {
  p.validate();
  RailLine line;
  int dofs = 0;
  for (int i = 0; i <= p.elements; ++i) {
    const bool at_support = i == 0 || i == p.elements;
    DofIndices dof;
    dof.fill(held);
    if (!at_support) dof[2] = dofs++;
    dof[4] = dofs++;
    line.x.push_back(p.length * i / p.elements);
    line.dof.push_back(dof);
  }
  BeamSection section;
  section.E = p.E;
  section.Iy = p.I;
  section.mass = p.mass;
  const BeamMatrix K = beam_stiffness(section, p.length / p.elements);
  const BeamMatrix M = beam_mass(section, p.length / p.elements);
  MatrixAssembly assembly;
  for (int e = 0; e < p.elements; ++e) {
    const std::array<int, 12> dof = joined(line.dof[e], line.dof[e + 1]);
    add_element(assembly.stiffness, dof, K);
    add_element(assembly.mass, dof, M);
  }
  StructureModel model;
  build_matrices(assembly, dofs, model);
  model.nodes.push_back({"deck-midspan-1", line.x[p.elements / 2], line.dof[p.elements / 2]});
  model.rail = {line, line};
  return model;
}

}  // namespace railtab
