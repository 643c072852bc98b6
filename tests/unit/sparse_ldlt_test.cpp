#include "railtab/runtime/algebra/sparse_ldlt.hpp"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <Eigen/SparseLU>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>
#include <vector>

#include "railtab/runtime/base/input_error.hpp"
#include "railtab/runtime/structure/track_bridge.hpp"
#include "substitution_check.hpp"

namespace railtab {
namespace {

Eigen::SparseMatrix<double> short_track() {
  TrackParameters track;
  track.length_before = track.length_after = 12.0;
  return effective_matrix(build_track_bridge(track, {BridgeParameters{}, BridgeParameters{}}));
}

/// Laplace's operator on a cube of n³ points: fronts as wide as a cross-section, unlike those of a track.
Eigen::SparseMatrix<double> cube(int n) {
  const auto at = [&](int x, int y, int z) { return x + n * (y + n * z); };
  std::vector<Eigen::Triplet<double>> entries;
  for (int z = 0; z < n; ++z) {
    for (int y = 0; y < n; ++y) {
      for (int x = 0; x < n; ++x) {
        entries.emplace_back(at(x, y, z), at(x, y, z), 6.0 + 0.01 * x);
        for (const auto& [i, j, k] : {std::array{x + 1, y, z}, std::array{x, y + 1, z}, std::array{x, y, z + 1}}) {
          if (std::max({i, j, k}) == n) continue;
          entries.emplace_back(at(x, y, z), at(i, j, k), -1.0);
          entries.emplace_back(at(i, j, k), at(x, y, z), -1.0);
        }
      }
    }
  }
  Eigen::SparseMatrix<double> matrix(n * n * n, n * n * n);
  matrix.setFromTriplets(entries.begin(), entries.end());
  return matrix;
}

TEST(SparseLdlt, SolvesAsAFactorisationWithoutSymmetryDoes) {
  for (const auto& [matrix, bound] : {std::pair{short_track(), 1e-10}, std::pair{cube(12), 1e-13}}) {
    const Eigen::VectorXd load = Eigen::VectorXd::Random(matrix.rows());
    const Eigen::VectorXd expected = Eigen::SparseLU<Eigen::SparseMatrix<double>>(matrix).solve(load);
    for (const EliminationOrder order : {EliminationOrder::minimum_degree, EliminationOrder::nested_dissection}) {
      EXPECT_LT(difference(SparseLdlt(matrix, {0, matrix.rows()}, "", order).solve(load), expected), bound);
    }
  }
}

TEST(SparseLdlt, SolvesColumnsTogetherAsOneByOne) {
  for (const auto& matrix : {short_track(), cube(12)}) {
    const DofRange range{3, matrix.rows() - 7};
    const SparseLdlt factor(matrix, range);
    constexpr Eigen::Index columns = 19;  // more than are taken together
    const Eigen::MatrixXd loads = Eigen::MatrixXd::Random(matrix.rows(), columns);
    const Eigen::MatrixXd solutions = factor.solve_columns(loads);
    for (Eigen::Index k = 0; k < columns; ++k) {
      const Eigen::VectorXd alone = factor.solve(loads.col(k));
      EXPECT_LT(difference(solutions.col(k), alone), 1e-12);
      EXPECT_EQ(solutions.col(k).head<3>(), Eigen::Vector3d::Zero());
    }
  }
}

TEST(SparseLdlt, AMatrixThatIsNotPositiveDefiniteIsRejected) {
  Eigen::SparseMatrix<double> matrix = cube(8);
  for (const double entry : {-1.0, 0.0, std::numeric_limits<double>::quiet_NaN()}) {
    matrix.coeffRef(200, 200) = entry;
    EXPECT_THROW(SparseLdlt(matrix, "not positive definite"), ComputationError) << entry;
  }
}

// A run that is resumed allocates other memory than one that is not.
TEST(SparseLdlt, MemoryElsewhereChangesNoBit) {
  const Eigen::SparseMatrix<double> matrix = short_track();
  const Eigen::VectorXd load = Eigen::VectorXd::LinSpaced(matrix.rows(), 0.0, 1.0);
  const Eigen::VectorXd first = SparseLdlt(matrix).solve(load);
  std::vector<std::vector<double>> between;
  for (std::size_t i = 0; i < 20; ++i) {
    between.emplace_back(1000 + 17 * i, std::numeric_limits<double>::quiet_NaN());
    EXPECT_EQ(SparseLdlt(matrix).solve(load), first) << i;
  }
}

// What a factor says of its memory before it is made is what it takes.
TEST(SparseLdlt, CountsItsMemory) {
  for (const auto& matrix : {short_track(), cube(12)}) {
    for (const EliminationOrder order : {EliminationOrder::minimum_degree, EliminationOrder::nested_dissection}) {
      const DofRange all{0, matrix.rows()};
      EXPECT_EQ(SparseLdlt::memory(matrix, all, order).stored, SparseLdlt(matrix, all, "", order).stored_bytes());
    }
  }
}

TEST(SparseLdlt, UnconnectedUnknownsAreBlocksOfTheirOwn) {
  Eigen::SparseMatrix<double> diagonal(3, 3);
  for (int i = 0; i < 3; ++i) diagonal.insert(i, i) = i + 1.0;
  const SparseLdlt factor(diagonal);
  EXPECT_TRUE(factor.solve(Eigen::Vector3d(1.0, 2.0, 3.0)).isApprox(Eigen::Vector3d::Ones(), 1e-15));
}

/// Equal blocks of neighbouring columns that hang on others. What they hang on takes in some: different numbers of them
/// leave eights, fours and single ones.
Eigen::MatrixXd hanging_blocks(Eigen::Index blocks, Eigen::Index columns) {
  constexpr Eigen::Index hub = 3;
  const Eigen::Index n = blocks * columns + hub;
  Eigen::MatrixXd dense = 20.0 * Eigen::MatrixXd::Identity(n, n);
  dense.bottomRightCorner<hub, hub>() *= 100.0;
  for (Eigen::Index b = 0; b < blocks; ++b) {
    const Eigen::Index first = columns * b;
    const double of_block = std::sqrt(1.0 + static_cast<double>(b));
    auto own = dense.block(first, first, columns, columns);
    own.array() += of_block;
    own.diagonal() += Eigen::VectorXd::LinSpaced(columns, 0.1, 1.0);
    // What is a row's place in one block's list is not its place in another's.
    const Eigen::Index row = n - hub + (b < 5 ? 1 : 0);
    dense.block(row, first, 2, columns).setConstant(-of_block);
    dense.block(first, row, columns, 2).setConstant(-of_block);
  }
  return dense;
}

constexpr Eigen::Index least_blocks = 5, most_blocks = 22;

TEST(SparseLdlt, EqualBlocksActOnTheSameRows) {
  for (Eigen::Index blocks = least_blocks; blocks <= most_blocks; ++blocks) {
    for (const Eigen::Index columns : {1, 2, 3, 4, 5, 6, 7, 8, 9}) {
      const Eigen::MatrixXd dense = hanging_blocks(blocks, columns);
      const SparseLdlt factor(dense.sparseView());
      const Eigen::VectorXd load = Eigen::VectorXd::LinSpaced(dense.rows(), -1.0, 2.0);
      const Eigen::VectorXd expected = dense.llt().solve(load);
      EXPECT_LT(difference(factor.solve(load), expected), 1e-14) << blocks << ", " << columns;
      EXPECT_LT(difference(factor.solve_columns(load), expected), 1e-14) << blocks << ", " << columns;
      // Some of those side by side are on the path, some are not.
      for (Eigen::Index block = 0; block < blocks; block += 3) {
        const int unknown = static_cast<int>(columns * block), other = static_cast<int>(columns) * 4;
        expect_divided_as_whole(factor, factor, {{unknown, other}, {unknown + 1}, {}}, 1e-14);
        expect_few_as_all(factor, dense.rows(), {unknown}, {other});
      }
    }
  }
}

// A run that is resumed has other paths than one that is not.
TEST(SparseLdlt, APathChangesNoBit) {
  for (Eigen::Index blocks = least_blocks; blocks <= most_blocks; ++blocks) {
    for (const Eigen::Index columns : {1, 2, 3, 4, 5, 6, 7, 8}) {
      const SparseLdlt factor(hanging_blocks(blocks, columns).sparseView());
      std::vector<int> all(static_cast<std::size_t>(factor.size()));
      std::iota(all.begin(), all.end(), 0);
      const Eigen::VectorXd load = Eigen::VectorXd::LinSpaced(factor.size(), -1.0, 2.0).array().sin();
      DividedSubstitution on_path;
      on_path.begin(factor, Eigen::VectorXd::Zero(factor.size()), {all, {}});
      Eigen::VectorXd found = Eigen::VectorXd::Zero(factor.size());
      on_path.respond(factor, 1.0, load, found);
      EXPECT_EQ(found, factor.solve(load)) << blocks << ", " << columns;
    }
  }
}

TEST(SparseLdlt, KeepsALoadThatIsNotANumber) {
  const Eigen::SparseMatrix<double> matrix = short_track();
  expect_nan_is_kept(SparseLdlt(matrix), matrix.rows(), 700);
}

TEST(DividedSubstitution, AnswersAChangingLoadAndGivesTheWholeSolution) {
  const Eigen::SparseMatrix<double> matrix = short_track();
  const SparseLdlt factor(matrix);
  expect_divided_as_whole(factor, factor, {{700, 3, 3, 704, 12}, {5}, {}}, 1e-12);
  expect_few_as_all(factor, matrix.rows(), {700, 3}, {705, 14});
}

// Unknowns that lie on the path in one factor are looked for in the other.
TEST(DividedSubstitution, SubstitutesInTurnWithSeveralFactors) {
  const Eigen::SparseMatrix<double> matrix = short_track(), stiffer = 3.0 * matrix;
  const DofRange all{0, matrix.rows()};
  const SparseLdlt one(matrix, all, "", EliminationOrder::minimum_degree);
  const SparseLdlt other(stiffer, all, "", EliminationOrder::nested_dissection);
  const std::vector<int> few{700, 12};
  Eigen::VectorXd load = Eigen::VectorXd::Zero(all.count);
  load[700] = 1.0;
  const Eigen::VectorXd expected = one.solve(load);
  DividedSubstitution solution;
  for (int round = 0; round < 2; ++round) {
    for (const auto& [factor, size] : {std::pair{&one, 1.0}, std::pair{&other, 3.0}}) {
      Eigen::VectorXd whole = load;
      solution.begin(*factor, load, {few, {}});
      solution.respond(*factor, whole);
      solution.finish(*factor, whole);
      EXPECT_LT(difference(size * whole, expected), 1e-12);
    }
  }
}

}  // namespace
}  // namespace railtab
