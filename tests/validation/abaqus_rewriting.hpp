#pragma once

// A model that CalculiX has assembled, in the files that Abaqus's *MATRIX OUTPUT would write of it: with the degrees of
// freedom that are held, which CalculiX leaves out, and with negative numbers for nodes that only the program knows.

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <set>
#include <stdexcept>
#include <utility>
#include <vector>

#include "railtab/runtime/structure/fe_structure.hpp"

namespace railtab::testing {

enum class AbaqusFormat { matrix_input, coordinate };

/// Files beside those of `calculix`, whose mesh has solids alone: three translations at each node.
class AbaqusRewriting {
 public:
  using Name = std::pair<int, int>;  // node, degree of freedom

  AbaqusRewriting(const FeFiles& calculix, AbaqusFormat format) : calculix_(calculix), format_(format) {
    const FeMesh mesh = read_fe_mesh(calculix.nodes);
    const int last = mesh.nodes.rbegin()->first;
    std::set<Name> free;
    for (const FeRow& row : read_calculix_rows(calculix.dofs)) {
      const bool of_mesh = row.node <= last;
      names_.push_back({of_mesh ? row.node : last - row.node, row.motion + 1});
      free.insert(names_.back());
    }
    for (const auto& [node, position] : mesh.nodes) {
      for (int dof = 1; dof <= 3; ++dof) {
        if (!free.contains({node, dof})) held_.push_back({node, dof});
      }
    }
  }

  [[nodiscard]] const std::vector<Name>& held() const { return held_; }

  [[nodiscard]] FeFiles written() const {
    FeFiles files;
    files.format = FeFormat::abaqus;
    files.nodes = calculix_.nodes;
    const bool input = format_ == AbaqusFormat::matrix_input;
    const std::filesystem::path folder = calculix_.stiffness.parent_path();
    files.stiffness = folder / (input ? "job_STIF1.mtx" : "numbered_STIF1.mtx");
    files.mass = folder / (input ? "job_MASS1.mtx" : "numbered_MASS1.mtx");
    write(files.stiffness, calculix_.stiffness, 1e36);
    write(files.mass, calculix_.mass, 17.0);
    if (!input) {
      files.dofs = folder / "rows.csv";
      std::ofstream table(files.dofs);
      table << "row,node,motion\n";
      for (std::size_t r = 0; r < names_.size() + held_.size(); ++r) {
        const auto [node, dof] = r < held_.size() ? held_[r] : names_[r - held_.size()];
        table << r + 1 << ',' << node << ',' << "xyz"[dof - 1] << '\n';
      }
    }
    return files;
  }

 private:
  void line(std::FILE* out, std::size_t i, std::size_t j, double value) const {  // in the order held, free
    const auto name = [&](std::size_t r) { return r < held_.size() ? held_[r] : names_[r - held_.size()]; };
    if (format_ == AbaqusFormat::coordinate) {
      std::fprintf(out, "%zu %zu %22.15e\n", i + 1, j + 1, value);
      if (i != j) std::fprintf(out, "%zu %zu %22.15e\n", j + 1, i + 1, value);  // both triangles
      return;
    }
    std::fprintf(out, "%d,%d, %d,%d, %22.15e\n", name(i).first, name(i).second, name(j).first, name(j).second, value);
  }

  void write(const std::filesystem::path& file, const std::filesystem::path& matrix, double of_held) const {
    std::FILE* out = std::fopen(file.c_str(), "w");
    if (out == nullptr) throw std::runtime_error("no file " + file.string());
    for (std::size_t h = 0; h < held_.size(); ++h) {
      line(out, h, h, of_held);
      line(out, held_.size() + h, h, -of_held / 1e27);  // a coupling to a free row
    }
    std::ifstream in(matrix);
    std::size_t row = 0, column = 0;
    for (double value = 0.0; in >> row >> column >> value;) {
      line(out, held_.size() + column - 1, held_.size() + row - 1, value);  // CalculiX: upper; Abaqus: lower
    }
    std::fclose(out);
  }

  FeFiles calculix_;
  AbaqusFormat format_;
  std::vector<Name> names_;  // of CalculiX's rows, in their order
  std::vector<Name> held_;
};

}  // namespace railtab::testing
