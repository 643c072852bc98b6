// What the code below the readers finds wrong with the numbers of a file is said with the name of that file.

#include "../unit/small_geometry_table.hpp"
#include "railtab/tables/creep_table.hpp"
#include "railtab/tables/files/creep_table_file.hpp"
#include "railtab/tables/files/geometry_table_file.hpp"
#include "vsi_fixture.hpp"

namespace railtab {
namespace {

TEST_F(VsiCommand, AGeometryTableOfWrongNumbersIsNamed) {
  GeometryTableData table = small_geometry_table();
  table.node[0] = CellNode::halved(0, 0);
  write_geometry_table(folder_ / "cells.h5", table);
  table = small_geometry_table();
  table.flange_back = 1e-300;
  write_geometry_table(folder_ / "wheelset.h5", table);
  table = small_geometry_table();
  table.rail.y[3] = 9e15;
  write_geometry_table(folder_ / "knots.h5", table);
  write("q.csv", "y,yaw,roll,dz\n0,0,0,1e-4\n");
  expect_rejected("contact knots.h5 --query q.csv -o out", "knots.h5: profile made-up rail, knot 3: found (9e+15, ");
  expect_rejected("contact cells.h5 --query q.csv -o out", "cells.h5: node 0: found halves at node 0");
  expect_rejected("contact wheelset.h5 --query q.csv -o out", "wheelset.h5: ");
  write("scene.toml", "[contact]\ntable = \"cells.h5\"\n[track]\nkind = \"rigid\"\n[integration]\nduration = 0.1\n");
  expect_rejected("run scene.toml -o out", "scene.toml:2: contact.table: cells.h5: node 0: found halves at node 0");
  write("no.h5", "no table");
  const std::string rest = "[track]\nkind = \"rigid\"\n[integration]\nduration = 0.1\n";
  for (const char* mode : {"table", "online"}) {
    write("scene.toml", std::string("[contact]\nmode = \"") + mode + "\"\ntable = \"no.h5\"\n" + rest);
    expect_rejected("run scene.toml -o out", "scene.toml:3: contact.table: no.h5: found no HDF5 signature");
  }
  write_geometry_table(folder_ / "good.h5", small_geometry_table());
  write("scene.toml", "[contact]\ntable = \"good.h5\"\n[[profiles]]\ncoach = 1\ntable = \"no.h5\"\n" + rest);
  expect_rejected("run scene.toml -o out", "scene.toml:3: [[profiles]] 1 of 1: no.h5: found no HDF5 signature");
}

TEST_F(VsiCommand, ACreepTableOfWrongNumbersIsNamed) {
  CreepTableData table;
  table.layout = CreepTableLayout::paper;
  table.poisson = 0.28;
  table.elements = 8;
  table.nodes = {{{1e-9, 2.0}, {0.0, 1.0, 3.0}, {0.0, 0.5}, {0.0}}};
  table.values.assign(std::size_t{3} * 2 * 3 * 2, 0.25);
  write_creep_table(folder_ / "creep.h5", table);
  write("q.csv", "ratio,ux,uy,phi\n1,0.1,0,0\n");
  const Outcome outcome = vsi("creep creep.h5 --query q.csv -o out");
  EXPECT_EQ(outcome.exit_code, 2) << outcome.output;
  EXPECT_TRUE(outcome.output.starts_with("vsi: creep.h5: ")) << outcome.output;
}

TEST_F(VsiCommand, AVehicleThatCannotStandIsNamedWithItsFile) {
  const std::string wagon =
      "name = \"wagon\"\ndescription = \"two axles\"\nnominal_radius = 0.46\nlength = 8.0\n[car_body]\nmass = 2e4\n"
      "Jx = 2e4\nJy = 1e5\nJz = 1e5\nheight = 1.5\n[wheelset]\nx = [2.0, -2.0]\nmass = 1500.0\nJx = 900.0\n"
      "Jy = 100.0\nJz = 900.0\n[[connection]]\nname = \"springs\"\n"
      "joins = [[\"wheelset-1\", \"car-body\"], [\"wheelset-2\", \"car-body\"]]\ny = 1.0\nboth_sides = true\n"
      "height = 0.46\nkx = 5e6\nky = 3e6\n";
  write("hanging.toml", wagon + "cz = 2e4\n");
  expect_rejected("vehicle hanging.toml",
                  "hanging.toml: wagon: found a weight of 1.96e+05 N of car-body that no spring carries");
  write("falling.toml", wagon + "kz = 1e4\n");
  expect_rejected("vehicle falling.toml",
                  "falling.toml: wagon: found a vehicle that falls over under its weight, car-body first, ω² = ");
}

TEST_F(VsiCommand, AGaugeHeightThatTheRailDoesNotReachNamesTheScene) {
  write("scene.toml",
        "[contact]\nmode = \"online\"\ndimensions.gauge_height = 0.05\n[track]\nkind = \"rigid\"\n"
        "[integration]\nduration = 0.1\n");
  expect_rejected("run scene.toml -o out", "scene.toml");
}

}  // namespace
}  // namespace railtab
