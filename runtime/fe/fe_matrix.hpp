#pragma once

#include <Eigen/SparseCore>
#include <filesystem>
#include <string_view>

namespace railtab {

/// One file named for two matrices, or copied over another. @throws InputError naming `key` where the numbers are the
/// stiffness's
void require_other_numbers(std::string_view key, const std::filesystem::path& file,
                           const Eigen::SparseMatrix<double>& matrix, const std::filesystem::path& stiffness_file,
                           const Eigen::SparseMatrix<double>& stiffness);

/// (A + Aᵀ)/2. @throws InputError with file, row and column where the two differ by more than 1e-9 of the largest
/// diagonal entry, or with the size where the matrix is not rows × rows (rows = 0: any square).
[[nodiscard]] Eigen::SparseMatrix<double> symmetric_mean(const std::filesystem::path& file,
                                                         const Eigen::SparseMatrix<double>& matrix, Eigen::Index rows);

}  // namespace railtab
