#include "railtab/runtime/scene/key_table.hpp"

namespace railtab::scene {
namespace {

template <auto member>
auto& of_load(SceneDraft& draft) {
  return draft.load.*member;
}
template <std::size_t component>
std::optional<double>& load_component(SceneDraft& draft) {
  return draft.load.load[component];
}
template <auto member>
auto& of_ground(SceneDraft& draft) {
  return draft.ground.*member;
}

std::vector<KeyRow> body_load_keys() {
  return {
      {"load.body", "", "name of the body, as bogie-1, wheelset-4", TextKey{of_load<&LoadParameters::body>, nullptr}},
      {"load.coach", "1", "counted from the front; 0: all", IntegerKey{of_load<&LoadParameters::coach>, 0, 100}},
      {"load.file",
       "",
       "history, in place of components or of wind_speed",
       FileKey{of_load<&LoadParameters::file>},
       {},
       {&load_zero}},
      {"load.Fx", "N", "force at the centre of gravity", OptionalNumberKey{load_component<0>, {-1e8, 1e8}}},
      {"load.Fy", "N", "force at the centre of gravity", OptionalNumberKey{load_component<1>, {-1e8, 1e8}}},
      {"load.Fz", "N", "force at the centre of gravity", OptionalNumberKey{load_component<2>, {-1e8, 1e8}}},
      {"load.Mx", "N m", "moment", OptionalNumberKey{load_component<3>, {-1e9, 1e9}}},
      {"load.My", "N m", "moment", OptionalNumberKey{load_component<4>, {-1e9, 1e9}}},
      {"load.Mz", "N m", "moment", OptionalNumberKey{load_component<5>, {-1e9, 1e9}}},
      {"load.start",
       "s",
       "start of the gust, or offset of the file's times (of its positions, in m)",
       NumberKey{of_load<&LoadParameters::start>, {-1e6, 1e6}},
       {},
       {&load_outside_run}},
      {"load.gust_duration",
       "s",
       "duration of a gust (1 − cos)/2 with the components or wind_speed as its peak; 0: constant",
       NumberKey{of_load<&LoadParameters::gust_duration>, {1e-6, 1e5, true}},
       {},
       {&load_shorter_than_steps}},
  };
}

std::vector<KeyRow> wind_keys() {
  return {
      {"load.wind_speed", "m/s", "speed of the wind over the ground",
       OptionalNumberKey{of_load<&LoadParameters::wind_speed>, {0.0, 200.0}}},
      {"load.wind_direction", "deg", "where it comes from: 0 ahead, 90 the left, -90 the right",
       NumberKey{of_load<&LoadParameters::wind_direction>, {-180.0, 180.0}}},
      {"load.air_density", "kg/m3", "density of the air", NumberKey{of_load<&LoadParameters::air_density>, {0.1, 2.0}}},
      {"load.area", "m2", "area that the coefficients refer to",
       NumberKey{of_load<&LoadParameters::area>, {0.1, 1000.0}}},
      {"load.length", "m", "length that the coefficients of the moments refer to",
       NumberKey{of_load<&LoadParameters::length>, {0.1, 1000.0}}},
  };
}

std::vector<KeyRow> ground_keys() {
  return {
      {"ground_motion.file",
       "",
       "record of acceleration or displacement",
       FileKey{of_ground<&GroundMotionParameters::file>},
       {},
       {&ground_with_gap, &ground_with_swing, &ground_drift, &ground_lateral_motion}},
      {"ground_motion.x",
       "m",
       "position of a station",
       NumberKey{of_ground<&GroundMotionParameters::x>, {-1e6, 1e6}},
       {},
       {&ground_moves_nothing}},
      {"ground_motion.factor",
       "1",
       "factor on the record",
       NumberKey{of_ground<&GroundMotionParameters::factor>, {-1e4, 1e4}},
       {},
       {&ground_at_rest, &ground_too_strong}},
      {"ground_motion.start",
       "s",
       "offset of the times of the record",
       NumberKey{of_ground<&GroundMotionParameters::start>, {0.0, 1e5}},
       {},
       {&ground_after_run}},
      {"ground_motion.wave_speed", "m/s",
       "speed of a single record as a wave, backward where negative; 0: uniform motion",
       NumberKey{of_ground<&GroundMotionParameters::wave_speed>, {10.0, 1e5, true, true}}},
  };
}

}  // namespace

std::vector<KeyRow> load_keys() {
  return all_of({body_load_keys(),
                 {{"load.aerodynamics", "", "wind load: coefficients of a vehicle over the yaw angle",
                   FileKey{of_load<&LoadParameters::aerodynamics>}}},
                 applying(with_aerodynamics, wind_keys()),
                 ground_keys()});
}

}  // namespace railtab::scene
