#include "railtab/runtime/structure/structure_import.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <filesystem>
#include <fstream>
#include <string>

#include "railtab/runtime/base/input_error.hpp"
#include "railtab/runtime/fe/fe_files.hpp"
#include "railtab/runtime/structure/simple_beam.hpp"

namespace railtab {
namespace {

class StructureImport : public ::testing::Test {
 protected:
  void SetUp() override {
    folder = std::filesystem::temp_directory_path() /
             (std::string("railtab_") + ::testing::UnitTest::GetInstance()->current_test_info()->name());
    std::filesystem::create_directories(folder);
  }
  void TearDown() override { std::filesystem::remove_all(folder); }

  std::filesystem::path write(const std::string& name, const std::string& text) const {
    std::ofstream(folder / name) << text;
    return folder / name;
  }
  std::filesystem::path write(const std::string& name, const Eigen::MatrixXd& matrix, bool symmetric) const {
    std::ofstream out(folder / name);
    out.precision(17);
    out << "%%MatrixMarket matrix coordinate real " << (symmetric ? "symmetric" : "general") << "\n% made by a test\n";
    long count = 0;
    std::string body;
    for (Eigen::Index j = 0; j < matrix.cols(); ++j) {
      for (Eigen::Index i = symmetric ? j : 0; i < matrix.rows(); ++i) {
        if (matrix(i, j) == 0.0) continue;
        ++count;
        char line[80];
        std::snprintf(line, sizeof line, "%ld %ld %.17g\n", static_cast<long>(i + 1), static_cast<long>(j + 1),
                      matrix(i, j));
        body += line;
      }
    }
    out << matrix.rows() << ' ' << matrix.cols() << ' ' << count << '\n' << body;
    return folder / name;
  }

  // A file that is rejected, and the words that the message must have.
  template <class Read>
  static void expect_rejected(const Read& read, std::initializer_list<std::string> words) {
    try {
      read();
      FAIL() << "accepted";
    } catch (const InputError& wrong) {
      for (const std::string& word : words)
        EXPECT_NE(std::string(wrong.what()).find(word), std::string::npos) << wrong.what();
    }
  }

  std::filesystem::path folder;
};

// A beam written as a finite-element program with z up and slopes dz_up/dx would, and read back.
TEST_F(StructureImport, GivesTheStructureThatWasWritten) {
  const StructureModel beam = build_simple_beam({.elements = 4});
  Eigen::VectorXd sign = Eigen::VectorXd::Ones(beam.dofs());
  std::string table = "# a beam\nrow,node,x[m],motion,rail\n";
  for (std::size_t n = 0; n < beam.rail[0].x.size(); ++n) {
    const DofIndices& dof = beam.rail[0].dof[n];
    const std::string node = ",n" + std::to_string(n) + "," + std::to_string(beam.rail[0].x[n]);
    if (dof[2] != held) {
      sign[dof[2]] = -1.0;
      table += std::to_string(dof[2] + 1) + node + ",-z,both\n";
    }
    table += std::to_string(dof[4] + 1) + node + ",pitch,both\n";
  }
  const auto turned = [&](const Eigen::SparseMatrix<double>& m) {
    return Eigen::MatrixXd(sign.asDiagonal() * Eigen::MatrixXd(m) * sign.asDiagonal());
  };
  const auto files =
      StructureFiles{write("m.mtx", turned(beam.mass), true), write("c.mtx", turned(beam.damping), false),
                     write("k.mtx", turned(beam.stiffness), false), write("dofs.csv", table)};
  // Supported ends have no z: a rail needs it everywhere.
  expect_rejected([&] { static_cast<void>(import_structure(files)); }, {"dofs.csv:3", "motion z"});

  std::string inner;
  for (std::size_t begin = 0, line = 0; begin < table.size(); ++line) {
    const std::size_t end = table.find('\n', begin) + 1;
    const std::string text = table.substr(begin, end - begin);
    if (text.find(",n0,") == std::string::npos && text.find(",n4,") == std::string::npos) inner += text;
    begin = end;
  }
  const StructureModel read = import_structure({files.mass, files.damping, files.stiffness, write("inner.csv", inner)});
  EXPECT_TRUE(Eigen::MatrixXd(read.stiffness).isApprox(Eigen::MatrixXd(beam.stiffness), 1e-15));
  EXPECT_TRUE(Eigen::MatrixXd(read.mass).isApprox(Eigen::MatrixXd(beam.mass), 1e-15));
  ASSERT_EQ(read.rail[0].x.size(), 3u);
  for (std::size_t n = 0; n < 3; ++n) {
    EXPECT_EQ(read.rail[0].dof[n], beam.rail[0].dof[n + 1]);
    EXPECT_EQ(read.rail[1].x[n], beam.rail[0].x[n + 1]);
  }
}

// A beam whose second end nothing carries: the node that moves is named.
TEST_F(StructureImport, AMotionThatNothingHoldsIsNamed) {
  Eigen::Matrix4d K;  // of a beam of length 1 with EI = 1
  K << 12, -6, -12, -6, -6, 4, 6, 2, -12, 6, 12, 6, -6, 2, 6, 4;
  K(0, 0) += 1.0;
  const auto k = write("k", Eigen::MatrixXd(K), true), m = write("m", Eigen::MatrixXd::Identity(4, 4), true);
  const auto dofs =
      write("dofs", "row,node,x[m],motion,rail\n1,a,0,z,both\n2,a,0,pitch,both\n3,b,1,z,both\n4,b,1,pitch,both\n");
  expect_rejected(
      [&] {
        static_cast<void>(import_structure({m, m, k, dofs}));
      },
      {"k: found a motion that nothing holds, the most of it at node ", "supports hold every motion"});
}

TEST_F(StructureImport, RejectsWrongMatricesWithFileAndLine) {
  const std::string banner = "%%MatrixMarket matrix coordinate real general\n";
  const auto rejected = [&](const std::string& text, std::initializer_list<std::string> words) {
    const auto file = write("a.mtx", text);
    expect_rejected([&] { static_cast<void>(read_matrix_market(file)); }, words);
  };
  rejected("%%MatrixMarket matrix array real general\n2 2\n", {"a.mtx:1", "coordinate"});
  rejected(banner + "% note\n2 2 1\n1 1 nan\n", {"a.mtx:4", "'nan'", "finite"});
  rejected(banner + "2 2 1\n1 1 1e999\n", {"a.mtx:3", "finite"});
  rejected(banner + "2 2 1\n3 1 1\n", {"a.mtx:3", "row 3", "1 to 2"});
  rejected(banner + "2 2 2\n1 1 1\n", {"1 entries", "2"});
  rejected(banner + "2 2 1\n1 1 1\n2 2 1\n", {"a.mtx:4", "1 entries"});
  rejected(banner + "2 2 1\n1 1\n", {"a.mtx:3", "row, column, value"});
  expect_rejected([&] { static_cast<void>(read_matrix_market(folder / "none.mtx")); }, {"none.mtx"});
}

TEST_F(StructureImport, RejectsMatricesThatDoNotBelongTogether) {
  const auto good = write("good.mtx", Eigen::MatrixXd(Eigen::Matrix2d::Identity()), false);
  const auto small = write("small.mtx", Eigen::MatrixXd::Identity(1, 1), false);
  Eigen::MatrixXd skew = Eigen::Matrix2d::Identity();
  skew(0, 1) = 0.5;
  const auto unsymmetric = write("skew.mtx", skew, false);
  const std::string header = "row,node,x[m],motion,rail\n";
  const auto dofs = write("d.csv", header + "1,a,0,z,both\n2,b,1,z,both\n");
  EXPECT_EQ(import_structure({good, good, good, dofs}).dofs(), 2);
  expect_rejected(
      [&] {
        static_cast<void>(import_structure({small, good, good, dofs}));
      },
      {"small.mtx", "1 x 1", "2 x 2"});
  expect_rejected(
      [&] {
        static_cast<void>(import_structure({good, good, unsymmetric, dofs}));
      },
      {"skew.mtx", "row 2, column 1", "symmetric"});
  const auto rejected = [&](const std::string& rows, std::initializer_list<std::string> words) {
    const auto file = write("e.csv", header + rows);
    expect_rejected([&] { static_cast<void>(import_structure({good, good, good, file})); }, words);
  };
  rejected("3,a,0,z,both\n", {"e.csv:2", "row '3'", "1 to 2"});
  rejected("1,a,0,z,both\n1,b,1,z,both\n", {"e.csv:3", "row 1 again"});
  rejected("1,a,0,up,both\n", {"e.csv:2", "motion 'up'"});
  rejected("1,a,nan,z,both\n", {"e.csv:2", "x 'nan'"});
  rejected("1,a,0,z,both\n2,a,1,pitch,both\n", {"e.csv:3", "another place"});
  rejected("1,a,0,z,both\n2,b,0,z,both\n", {"e.csv:3", "second node"});
  rejected("1,a,0,z,left\n2,b,1,z,both\n", {"1 nodes of the right rail"});
  rejected("1,a,0,z\n", {"e.csv:2", "4 columns"});
}

// Numbers that are finite and absurd: used, they give modes that were not found, or a factor without a right digit.
TEST_F(StructureImport, RejectsAbsurdScales) {
  const std::string header = "row,node,x[m],motion,rail\n";
  const auto dofs = write("d.csv", header + "1,a,0,z,both\n2,b,1,z,both\n");
  const auto none = write("c.mtx", Eigen::MatrixXd(Eigen::Matrix2d::Zero()), false);
  const auto matrix = [&](const std::string& name, double first, double second, double between) {
    Eigen::Matrix2d m;
    m << first, between, between, second;
    return write(name, Eigen::MatrixXd(m), false);
  };
  const auto rejected = [&](const std::filesystem::path& mass, const std::filesystem::path& stiffness,
                            std::initializer_list<std::string> words) {
    expect_rejected([&] { static_cast<void>(import_structure({mass, none, stiffness, dofs})); }, words);
  };
  const auto mass = matrix("m.mtx", 1e3, 2e3, 0.0), stiffness = matrix("k.mtx", 1e8, 2e8, -1e7);
  EXPECT_EQ(import_structure({mass, none, stiffness, dofs}).dofs(), 2);
  EXPECT_EQ(import_structure({matrix("m0.mtx", 1e3, 0.0, 0.0), none, stiffness, dofs}).dofs(), 2);
  rejected(matrix("m1.mtx", 1e3, 1e150, 0.0), stiffness,
           {"m1.mtx: row 2 (node b, z), column 2: found mass 1e+150, expected -1e+15 to 1e+15 in SI units"});
  rejected(mass, matrix("k1.mtx", 1e300, 2e8, 0.0), {"k1.mtx: row 1 (node a, z), column 1", "stiffness 1e+300"});
  rejected(mass, matrix("k2.mtx", 1e24, 1.0, 0.0),
           {"k2.mtx: row 1", "stiffness 1e+24 beside 1 in row 2", "1e+20 times"});
  rejected(matrix("m2.mtx", 1e3, 1e14, 0.0), stiffness, {"m2.mtx: row 2", "0.000225 Hz", "0.001 to 1e+12 Hz"});
  rejected(matrix("m3.mtx", 1e-12, 1e-3, 0.0), matrix("k3.mtx", 1e24, 1e24, 0.0), {"m3.mtx: row 1", "Hz"});
  rejected(matrix("m4.mtx", 1e3, 2e3, 1e6), stiffness, {"m4.mtx: row 2", "column 1", "mass 1e+06 with 2000 and 1000"});
  rejected(mass, matrix("k4.mtx", 1e8, 2e8, 1e12), {"k4.mtx: row 2", "positive semidefinite"});
}

}  // namespace
}  // namespace railtab
