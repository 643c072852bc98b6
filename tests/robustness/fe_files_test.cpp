// Files of finite-element programs: what they say is read, what is wrong is rejected with file and line.

#include "railtab/runtime/fe/fe_files.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <filesystem>
#include <fstream>
#include <string>

#include "../folder_fixture.hpp"
#include "railtab/runtime/base/input_error.hpp"
#include "railtab/runtime/fe/abaqus_files.hpp"
#include "railtab/runtime/structure/fe_structure.hpp"

namespace railtab {
namespace {

class FeFilesTest : public testing::InFolder {
 protected:
  // The message with which a file is rejected.
  template <class Read>
  std::string message(const Read& read, const std::string& text) const {
    const auto file = write("f", text);
    try {
      static_cast<void>(read(file));
    } catch (const InputError& wrong) {
      const std::string what = wrong.what();
      return what.substr(what.find(folder_.string()) == 0 ? folder_.string().size() + 1 : 0);
    }
    return "accepted";
  }
};

// Lines of a Harwell-Boeing header [DuffGrimesLewis1992]: counts in fields of 14, formats in fields of 16, 16 and 20.
std::string header(const std::string& type, int rows, int entries, const std::string& formats,
                   int right_hand_lines = 0) {
  char counts[160], sizes[160];
  std::snprintf(counts, sizeof counts, "%14d%14d%14d%14d%14d\n", 3, 1, 1, 1, right_hand_lines);
  std::snprintf(sizes, sizeof sizes, "%-14s%14d%14d%14d%14d\n", type.c_str(), rows, rows, entries, 0);
  return "A matrix of a test                                                      KEY     \n" + std::string(counts) +
         sizes + formats + "\n";
}
const char* const formats_of_five = "(8I5)           (8I5)           (1P,3E20.12)        (3E20.12)           ";

const Eigen::Matrix3d expected = (Eigen::Matrix3d() << 4, -1.5, 0, -1.5, 5, 250, 0, 250, 6e5).finished();

TEST_F(FeFilesTest, HarwellBoeingSymmetricKeepsOneTriangle) {
  const std::string text = header("RSA", 3, 5, formats_of_five) +
                           "    1    3    5    6\n    1    2    2    3    3\n"
                           "  4.000000000000D+00 -1.500000000000E+00  5.000000000000d+00\n"
                           "            2.500+02          6.000E+005\n";
  const Eigen::MatrixXd read(read_harwell_boeing(write("k.matrix", text)));
  EXPECT_TRUE(read.isApprox(expected, 0.0)) << read;
}

TEST_F(FeFilesTest, HarwellBoeingUnsymmetricOneEntryPerLineAndRightHandSides) {
  const std::string text = header("RUA", 3, 7, "(1I14)          (1I14)          (1D25.15)           (1D25.15)", 3) +
                           "F                          1             0\n"  // a fifth card, where there are such sides
                           "             1\n             3\n             6\n             8\n"
                           "             1\n             2\n             1\n             2\n             3\n"
                           "             2\n             3\n"
                           "    0.400000000000000D+01\n   -0.150000000000000D+01\n   -0.150000000000000D+01\n"
                           "    0.500000000000000D+01\n    0.250000000000000D+03\n    0.250000000000000D+03\n"
                           "    0.600000000000000D+06\n    1.0\n    1.0\n    1.0\n";
  const Eigen::MatrixXd read(read_harwell_boeing(write("k.matrix", text)));
  EXPECT_TRUE(read.isApprox(expected, 0.0)) << read;
}

TEST_F(FeFilesTest, HarwellBoeingRejections) {
  const auto rejected = [&](const std::string& text) { return message(read_harwell_boeing, text); };
  const std::string body = "    1    2    3\n    1    2\n  4.000000000000D+00 -1.500000000000E+00\n";
  EXPECT_EQ(rejected(header("RSA", 2, 2, formats_of_five) + body), "accepted");
  EXPECT_TRUE(rejected(header("CSA", 2, 2, formats_of_five) + body).starts_with("f:3: found matrix type 'CSA'"));
  EXPECT_TRUE(rejected(header("RSE", 2, 2, formats_of_five) + body).starts_with("f:3: found matrix type 'RSE'"));
  EXPECT_TRUE(rejected(header("RSA", 2, 2, "(8X5)           (8I5)           (3E20.12)") + body)
                  .starts_with("f:4: found format '(8X5)'"));
  EXPECT_TRUE(rejected(header("RSA", 2, 2, formats_of_five) + "    1    3    2\n")
                  .starts_with("f:5: found column 3 at place 2, expected 3 to 3"));
  EXPECT_TRUE(rejected(header("RSA", 2, 2, formats_of_five) + "    1    2    3\n    1    9\n")
                  .starts_with("f:6: found row 9, expected 1 to 2"));
  const std::string least = "(1I20)          (1I20)          (1E20.12)";
  EXPECT_TRUE(rejected(header("RSA", 1, 1, least) + "1\n2\n-9223372036854775808\n")
                  .starts_with("f:7: found row -9223372036854775808, expected 1 to 1"));
  EXPECT_TRUE(rejected(header("RSA", 2, 2, formats_of_five) + "    1    2    3\n    2    1\n")
                  .starts_with("f:6: found entries on both sides"));
  EXPECT_TRUE(
      rejected(header("RSA", 2, 2, formats_of_five) + "    1    2    3\n    1    2\n   4.00D+00            nan\n")
          .starts_with("f:7: found 'nan'"));
  EXPECT_TRUE(rejected(header("RSA", 2, 2, formats_of_five) + "    1    2    3\n    1    2\n")
                  .starts_with("f: found the end of the file"));
  EXPECT_TRUE(rejected(header("RSA", 2000000000, 2, formats_of_five)).starts_with("f:3: found 2000000000 rows"));
  EXPECT_TRUE(rejected(header("RSA", 2, 2000000000, formats_of_five)).starts_with("f:3: found 2000000000 entries"));
}

// A size line that promises what the file cannot hold is rejected before anything is allocated for it.
TEST_F(FeFilesTest, MatrixMarketOfAbsurdSizeIsRejectedAtItsSizeLine) {
  const std::string banner = "%%MatrixMarket matrix coordinate real general\n";
  EXPECT_TRUE(message(read_matrix_market, banner + "2000000000 2000000000 1\n1 1 1\n")
                  .starts_with("f:2: found 2000000000 rows and 2000000000 columns, expected 1 to 20000000"));
  EXPECT_TRUE(message(read_matrix_market, banner + "2 2 2000000000\n1 1 1\n")
                  .starts_with("f:2: found 2000000000 entries, expected at most"));
  EXPECT_TRUE(message(read_matrix_market, banner + "2 2 99999999999999999999\n").starts_with("f:2: found '9999"));
}

TEST_F(FeFilesTest, ASymmetricMatrixMarketFileIsSquare) {
  EXPECT_TRUE(message(read_matrix_market, "%%MatrixMarket matrix coordinate real symmetric\n3 2 1\n3 2 1\n")
                  .starts_with("f:2: found 3 rows and 2 columns of a symmetric matrix"));
}

// As programs of Windows write UTF-8.
TEST_F(FeFilesTest, AByteOrderMarkIsSkipped) {
  const std::string mark = "\xEF\xBB\xBF";
  const std::string matrix = "%%MatrixMarket matrix coordinate real general\n2 2 2\n1 1 3\n2 2 4\n";
  EXPECT_EQ(read_matrix_market(write("marked.mtx", mark + matrix)).coeff(1, 1), 4.0);
  const FeMesh nodes = read_fe_mesh(write("marked.txt", mark + "7 0.5 0. 0.25\n8 1 2 3\n"));
  EXPECT_EQ(nodes.nodes.at(7), Eigen::Vector3d(0.5, 0, 0.25));
  EXPECT_TRUE(message(read_fe_mesh, "7 0 0 0\n" + mark + "8 1 2 3\n").starts_with("f:2: found"));
}

TEST_F(FeFilesTest, CalculixMatrixAndRows) {
  const auto file = write("m.sti", "1 1  4.0\n1 2 -1.5\n2 2  5.0\n2 3  2.5e2\n3 3  6.0e5\n");
  EXPECT_TRUE(Eigen::MatrixXd(read_calculix_matrix(file, 3)).isApprox(expected, 0.0));
  const std::vector<FeRow> rows = read_calculix_rows(write("m.dof", "12.1\n12.3\n7.2\n"));
  ASSERT_EQ(rows.size(), 3u);
  EXPECT_EQ(rows[1].node, 12);
  EXPECT_EQ(rows[1].motion, 2);
  EXPECT_EQ(rows[2].node, 7);
  const auto rejected = [&](const std::string& text) {
    return message([](const auto& f) { return read_calculix_matrix(f, 3); }, text);
  };
  EXPECT_TRUE(rejected("1 1 4\n1 4 1\n").starts_with("f:2: found row 1, column 4, expected 1 to 3"));
  EXPECT_TRUE(rejected("1 2 4\n3 1 1\n").starts_with("f:2: found entries on both sides"));
  EXPECT_TRUE(rejected("1 1 inf\n").starts_with("f:1: found 'inf'"));
  EXPECT_TRUE(rejected("1 1\n2 2 4\n").starts_with("f:1: found '1 1', expected row, column, value"));
  const std::string again = ", expected a whole file: run ccx once more";
  EXPECT_TRUE(rejected("1 1 4\n2 2\n").starts_with("f:2: found the end of the file within the line '2 2'" + again));
  EXPECT_TRUE(rejected("1 1 4\n2 2 5\n").starts_with("f:2: found the end of the file after row 2 of 3" + again));
  EXPECT_TRUE(message(read_calculix_rows, "1.1\n1.7\n").starts_with("f:2: found '1.7'"));
  EXPECT_TRUE(message(read_calculix_rows, "").starts_with("f: found no line"));
}

/// Lines as Abaqus writes them: its own node -1, nodes 5 and 7, of which 5 is held along y.
const char* const abaqus_stiffness =
    "** a comment\n-1,1, -1,1,  6.000000000000000e+05\n7,1, -1,1,  2.500000000000000e+02\n"
    "5,1, 5,1,  4.000000000000000e+00\n7,1, 5,1, -1.500000000000000e+00\n5,2, 5,2,  1.000000000000000e+36\n"
    "7,1, 5,2,  3.000000000000000e+00\n7,1, 7,1,  5.000000000000000e+00\n";

TEST_F(FeFilesTest, AbaqusMatrixInput) {
  const auto file = write("k.mtx", abaqus_stiffness);
  const AbaqusRows rows = read_abaqus_rows(file, {});
  ASSERT_EQ(rows.rows.size(), 3u);
  EXPECT_EQ(rows.rows[0].node, 5);
  EXPECT_EQ(rows.rows[0].motion, 0);
  EXPECT_EQ(rows.rows[0].line, 4);
  EXPECT_EQ(rows.rows[1].node, 7);
  EXPECT_EQ(rows.rows[2].node, -1);
  const Eigen::MatrixXd read(read_abaqus_matrix(file, rows));
  EXPECT_TRUE(read.isApprox(expected, 0.0)) << read;
  const Eigen::MatrixXd mass(read_abaqus_matrix(write("m.mtx", "5,2,5,2,9.\n7,1, 7,1, 2.\n"), rows));
  EXPECT_TRUE(mass.isApprox(Eigen::Vector3d(0, 2, 0).asDiagonal().toDenseMatrix(), 0.0)) << mass;
  const auto rejected = [&](const std::string& text) {
    return message([&](const auto& f) { return read_abaqus_matrix(f, rows); }, text);
  };
  EXPECT_EQ(rejected("5,1, 7,1, 1.\n7,1, 5,1, 1.\n7,1, 7,1, 2.\n"), "accepted") << "both triangles";
  EXPECT_TRUE(rejected("5,1, 7,1, 1.\n7,1, 5,1, 3.\n7,1, 7,1, 2.\n").find("a symmetric matrix") != std::string::npos);
  EXPECT_TRUE(rejected("7,2, 7,2, 1.\n")
                  .starts_with("f:1: found node 7, degree of freedom 2, expected a row of the stiffness"));
  EXPECT_TRUE(rejected("-2,3, 7,1, 1.\n").starts_with("f:1: found node -2, degree of freedom 3"));
  EXPECT_TRUE(rejected("7,1, 7,1, nan\n").starts_with("f:1: found 'nan'"));
  EXPECT_TRUE(rejected("7,1, 7,1\n").starts_with("f:1: found '7,1, 7,1', expected node, degree of freedom, node"));
  EXPECT_TRUE(rejected("7,1, 7,1, 1., 2.\n").starts_with("f:1: found '7,1, 7,1, 1., 2.'"));
  EXPECT_TRUE(rejected("1 1 4.0\n").find("for COORDINATE structure.dofs") != std::string::npos);
  EXPECT_TRUE(rejected("** nothing\n").starts_with("f: found no entry"));
  const auto no_rows = [&](const std::string& text) {
    return message([](const auto& f) { return read_abaqus_rows(f, {}); }, text);
  };
  EXPECT_TRUE(no_rows("0,1, 0,1, 1.\n").starts_with("f:1: found node 0, degree of freedom 1"));
  EXPECT_TRUE(no_rows("3,8, 3,8, 1.\n").starts_with("f:1: found node 3, degree of freedom 8, expected 1 to 6"));
  EXPECT_TRUE(no_rows("-3,1000, 3,1, 1.\n").starts_with("f:1: found node -3, degree of freedom 1000"));
  EXPECT_TRUE(no_rows("99999999999,1, 3,1, 1.\n").starts_with("f:1: found '99999999999'"));
  EXPECT_TRUE(no_rows("3,1, 3,1, 1e36\n").starts_with("f: found no free row"));
}

TEST_F(FeFilesTest, AbaqusCoordinateFormatNeedsATableOfRows) {
  const auto table = write("rows.csv", "row,node,motion\n1,5,x\n2,5,y\n3,7,x\n4,-1,x\n");
  const auto file =
      write("k.mtx", "1 1 4.0\n2 2 1e36\n3 3 5.0\n4 4 6e5\n1 3 -1.5\n3 1 -1.5\n2 3 7\n3 2 7\n3 4 250\n4 3 250\n");
  const AbaqusRows rows = read_abaqus_rows(file, table);
  ASSERT_EQ(rows.rows.size(), 3u);
  EXPECT_EQ(rows.rows[1].node, 7);
  const Eigen::MatrixXd read(read_abaqus_matrix(file, rows));
  EXPECT_TRUE(read.isApprox(expected, 0.0)) << read;
  const auto rejected = [&](const std::string& text) {
    return message([&](const auto& f) { return read_abaqus_matrix(f, rows); }, text);
  };
  EXPECT_TRUE(rejected("5 1 4.0\n").starts_with("f:1: found row 5, expected a row of structure.dofs"));
  EXPECT_TRUE(rejected("5,1, 5,1, 4.0\n").find("for MATRIX INPUT no structure.dofs") != std::string::npos);
  EXPECT_TRUE(rejected("1 1.5 4.0\n").starts_with("f:1: found '1.5', expected a column number"));
}

// What the mesh says of axes of nodes and of places of parts is not silently left out.
TEST_F(FeFilesTest, AbaqusModelsWithOtherAxesAreRejected) {
  FeFiles files;
  files.format = FeFormat::abaqus;
  files.stiffness = write("k.mtx", "1,1, 1,1, 4.0\n");
  files.mass = write("m.mtx", "1,1, 1,1, 1.0\n");
  const auto rejected = [&](const std::string& nodes) {
    return message(
        [&](const auto& f) {
          files.nodes = f;
          return read_fe_structure(files, {});
        },
        nodes);
  };
  EXPECT_EQ(rejected("*NODE\n1, 0., 0., 0.\n*INSTANCE, NAME=A, PART=B\n0., 0., 0.\n*END INSTANCE\n"), "accepted");
  EXPECT_TRUE(
      rejected("*NODE\n1, 0., 0., 0.\n*TRANSFORM, NSET=S\n1, 1, 0, -1, 1, 0\n").starts_with("f:3: found *TRANSFORM"));
  EXPECT_TRUE(rejected("*NODE\n1, 0.\n*INSTANCE, NAME=A, PART=B\n5., 0., 0.\n")
                  .starts_with("f:4: found an *INSTANCE that is moved"));
  EXPECT_TRUE(rejected("*NODE, SYSTEM=C\n1, 0.\n").starts_with("f:1: found *NODE with a coordinate system"));
  EXPECT_TRUE(rejected("*SYSTEM\n1, 0.\n*NODE\n1, 0.\n").starts_with("f:1: found *SYSTEM with a coordinate system"));
  EXPECT_TRUE(rejected("*NODE\n2, 0.\n").find("k.mtx:1: found node 1 in row 1, expected a node of ") !=
              std::string::npos);
}

TEST_F(FeFilesTest, AnsysRowsComeInTheOrderOfTheEquations) {
  const auto rows = read_ansys_rows(write("k.mapping",
                                          "  Matrix Eqn     Node      DOF\n\n"
                                          "          2        5       ROTZ\n"
                                          "          1        5       UX\n"
                                          "          3       11       UZ\n"));
  ASSERT_EQ(rows.size(), 3u);
  EXPECT_EQ(rows[0].motion, 0);
  EXPECT_EQ(rows[1].motion, 5);
  EXPECT_EQ(rows[2].node, 11);
  EXPECT_TRUE(message(read_ansys_rows, "head\n1 5 UX\n2 5 TEMP\n").starts_with("f:3: found 'TEMP'"));
  EXPECT_TRUE(message(read_ansys_rows, "1 5 UX\n3 5 UY\n").starts_with("f: found row 2 missing"));
  EXPECT_TRUE(message(read_ansys_rows, "1 5 UX\n1 5 UY\n").starts_with("f:2: found row 1 again"));
  EXPECT_TRUE(message(read_ansys_rows, "1 5\n").starts_with("f:1: found '1 5'"));
  EXPECT_TRUE(message(read_row_table, "row,node\n").starts_with("f:1: found 'row,node'"));
  EXPECT_TRUE(message(read_row_table, "row,node,motion\n1,2,up\n").starts_with("f:2: found 'up'"));
  EXPECT_TRUE(message(read_row_table, "row,node,motion\n1,2,x\n2,2,x\n").starts_with("f:3: found x of node 2 again"));
}

TEST_F(FeFilesTest, MeshesOfDecksAndTables) {
  write("more.inp", "*NODE\n3, 7.5\n");
  const FeMesh deck = read_fe_mesh(write("deck.inp",
                                         "** a deck\n*HEADING\n1, 2, 3 are no nodes\n*Node, Nset=All\n"
                                         "1, 0., 1., 2.\n2, 5., 1., -2.e0\n*INCLUDE, INPUT=more.inp\n"
                                         "*ELEMENT, TYPE=B31\n1, 1, 2\n2, 2,\n3\n*NSET, NSET=ends\n1,\n3\n"
                                         "*nset, nset=Run, GENERATE\n1, 3, 2\n*NSET,NSET=BOTH\nENDS, 2\n"));
  ASSERT_EQ(deck.nodes.size(), 3u);
  EXPECT_EQ(deck.nodes.at(2), Eigen::Vector3d(5, 1, -2));
  EXPECT_EQ(deck.nodes.at(3), Eigen::Vector3d(7.5, 0, 0));
  EXPECT_EQ(deck.elements, 2u) << "one of them on two lines";
  EXPECT_EQ(deck.sets.at("ALL"), (std::vector<int>{1, 2}));
  EXPECT_EQ(deck.sets.at("RUN"), (std::vector<int>{1, 3}));
  EXPECT_EQ(deck.sets.at("BOTH"), (std::vector<int>{1, 3, 2}));
  const FeMesh table = read_fe_mesh(write("nodes.txt", "! from NWRITE\n 1\n 2  0.5  0.  0.25\n 3,1,2,3\n"));
  ASSERT_EQ(table.nodes.size(), 3u);
  EXPECT_FALSE(table.elements);
  EXPECT_EQ(table.nodes.at(1), Eigen::Vector3d::Zero());
  EXPECT_EQ(table.nodes.at(2), Eigen::Vector3d(0.5, 0, 0.25));
  EXPECT_TRUE(message(read_fe_mesh, "1 0 0 0\n1 1 0 0\n").starts_with("f:2: found node 1 again"));
  EXPECT_TRUE(message(read_fe_mesh, "1 0 0 0 30\n").starts_with("f:1: found node 1 with axes turned by 30"));
  EXPECT_TRUE(message(read_fe_mesh, "*NODE\n1, a\n").starts_with("f:2: found 'a'"));
  EXPECT_TRUE(message(read_fe_mesh, "*NODE\n1, 0\n*NSET, NSET=S\n9\n").starts_with("f: found node 9 in the set S"));
  EXPECT_TRUE(message(read_fe_mesh, "*NODE\n1, 0\n*NSET, NSET=S, GENERATE\n1, 2000000000, 1\n")
                  .starts_with("f:4: found sets of more nodes, expected at most"));
  EXPECT_TRUE(message(read_fe_mesh, "*NODE\n1, 0\n*NSET, NSET=S, GENERATE\n-2147483648, 2147483647, 1\n")
                  .starts_with("f:4: found '-2147483648"));
  EXPECT_TRUE(message(read_fe_mesh, "*NODE\n1, 0\n*NSET, NSET=S, GENERATE\n2147483646, 2147483647, 1\n")
                  .starts_with("f: found node 2147483646 in the set S"));
  std::string doubled = "*NODE\n1, 0\n*NSET, NSET=S\n1\n";
  for (int i = 0; i < 40; ++i) doubled += "S\n";
  EXPECT_NE(message(read_fe_mesh, doubled).find("found sets of more nodes"), std::string::npos);
  EXPECT_TRUE(message(read_fe_mesh, "*INCLUDE, INPUT=f\n").find("include each other") != std::string::npos);
  EXPECT_TRUE(message(read_fe_mesh, "# nothing\n").starts_with("f: found no node"));
}

}  // namespace
}  // namespace railtab
