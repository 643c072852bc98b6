#include "geometry_options.hpp"

#include "table_command_line.hpp"

namespace railtab {

namespace po = boost::program_options;

po::options_description pair_options(const std::string& caption) {
  po::options_description own(caption);
  own.add_options()("wheel", po::value<std::string>()->value_name("P"), "wheel profile: built-in name or file")  //
      ("rail", po::value<std::string>()->value_name("P"), "rail profile: built-in name or file")                 //
      ("smoothing", text_value("0")->value_name("M"),
       "measuring noise of profile files, standard deviation normal to the outline; 0: no smoothing")           //
      ("rail-inclination", text_value("1:40")->value_name("1:N"), "of a built-in rail")                         //
      ("gauge", text_value("1.435")->value_name("M"), "track gauge")                                            //
      ("gauge-height", text_value("0.014")->value_name("M"), "depth of the gauge points below the rail heads")  //
      ("flange-back", text_value("1.360")->value_name("M"), "distance of the flange backs")                     //
      ("wheel-radius", text_value("0.460")->value_name("M"), "nominal radius");
  return own;
}

po::options_description geometry_options() {
  po::options_description own = pair_options("Options (SI units)");
  own.add_options()("lateral", text_value("-0.012:0.012")->value_name("LO:HI"), "wheelset lateral shift")  //
      ("yaw", text_value("-0.030:0.030")->value_name("LO:HI"), "wheelset yaw")                             //
      ("roll", text_value("0:0")->value_name("LO:HI"), "wheelset roll against the rail head")              //
      ("tolerance", text_value("1e-8")->value_name("M"), "tolerance of the penetration")                   //
      ("refinement", text_value("0")->value_name("N"),
       "finer cells from the start, each time as after a missed tolerance (0..4)")                            //
      ("shard", po::value<std::string>()->value_name("I/N"), "make one of N parts only, for tablegen merge")  //
      ("output,o", po::value<std::string>()->value_name("FILE.h5"), "the table, or the shard");
  return own;
}

}  // namespace railtab
