#include "railtab/runtime/scene/key_table.hpp"

namespace railtab::scene {
namespace {

template <auto member>
auto& of_wheel(SceneDraft& draft) {
  return draft.wheel.*member;
}
template <auto part, auto member>
auto& of_part(SceneDraft& draft) {
  return draft.wheel.*part.*member;
}

constexpr Range angle{-1e3, 1e3};
constexpr Range amplitude{1e-7, 0.01, true};

}  // namespace

std::vector<KeyRow> wheel_keys() {
  return {
      {"wheel.coach", "1", "counted from the front; 0: all", IntegerKey{of_wheel<&WheelParameters::coach>, 0, 100}},
      {"wheel.wheelset", "1", "counted from the front; 0: all",
       IntegerKey{of_wheel<&WheelParameters::wheelset>, 0, 100}},
      {"wheel.side", "", "wheels of the wheelset",
       choice<WheelSides>(of_wheel<&WheelParameters::side>,
                          {{"both", WheelSides::both}, {"left", WheelSides::left}, {"right", WheelSides::right}})},
      {"wheel.flat_length", "m", "length of a flat; 0: none",
       NumberKey{of_part<&WheelParameters::flat, &WheelFlat::length>, {1e-3, 0.4, true}}},
      {"wheel.flat_angle", "rad", "rotation from t = 0 at which the wheel stands on the flat",
       NumberKey{of_part<&WheelParameters::flat, &WheelFlat::angle>, angle}},
      {"wheel.flat_edges", "", "edges of the flat, new or worn away",
       choice<WheelFlat::Edges>(of_part<&WheelParameters::flat, &WheelFlat::edges>,
                                {{"sharp", WheelFlat::Edges::sharp}, {"rounded", WheelFlat::Edges::rounded}})},
      {"wheel.polygon_order", "1", "waves of a polygon around the wheel",
       IntegerKey{of_part<&WheelParameters::polygon, &WheelHarmonic::order>, 1, 200}},
      {"wheel.polygon_amplitude", "m", "its amplitude",
       NumberKey{of_part<&WheelParameters::polygon, &WheelHarmonic::amplitude>, amplitude}},
      {"wheel.polygon_phase", "rad", "rotation at which it first runs highest",
       NumberKey{of_part<&WheelParameters::polygon, &WheelHarmonic::phase>, angle}},
      {"wheel.run_out", "m", "eccentricity of the tread about the axle",
       NumberKey{of_part<&WheelParameters::run_out, &WheelHarmonic::amplitude>, amplitude}},
      {"wheel.run_out_phase", "rad", "rotation at which it runs highest",
       NumberKey{of_part<&WheelParameters::run_out, &WheelHarmonic::phase>, angle}},
      {"wheel.file", "", "deviation of the wheel over its angle", FileKey{of_wheel<&WheelParameters::file>}},
  };
}

}  // namespace railtab::scene
