#include "railtab/runtime/scene/key_table.hpp"

namespace railtab::scene {
namespace {

std::vector<std::string> deviation_shapes() { return {"none", "bending", "parallel-shift"}; }
std::vector<std::string> deviation_directions() { return {"vertical", "lateral"}; }

template <auto member>
auto& of_deviation(SceneDraft& draft) {
  return draft.deviation.*member;
}
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

std::vector<KeyBinding> deviation_keys() {
  return {
      {"span_deviation.shape", "", "rails over spans that turn as rigid bodies",
       TextKey{[](SceneDraft& d) -> std::string& { return d.deviation_shape; }, deviation_shapes}},
      {"span_deviation.direction", "", "in which the spans turn",
       TextKey{[](SceneDraft& d) -> std::string& { return d.deviation_direction; }, deviation_directions}},
      {"span_deviation.span", "m", "length of a span",
       NumberKey{of_deviation<&SpanDeviationParameters::span>, {0.0, 1000.0, true}}},
      {"span_deviation.amplitude", "m", "largest deviation, down or to the right",
       NumberKey{of_deviation<&SpanDeviationParameters::amplitude>, {-0.5, 0.5}}},
      {"span_deviation.start", "m", "where the first span that turns begins",
       NumberKey{of_deviation<&SpanDeviationParameters::start>, {-1e6, 1e6}}},
      {"span_deviation.beta", "1/m", "relative bending stiffness of rails and pads; 0: 1.387 vertical, 3.239 lateral",
       NumberKey{of_deviation<&SpanDeviationParameters::beta>, {0.0, 1e3}}},
  };
}

std::vector<KeyBinding> body_load_keys() {
  return {
      {"load.body", "", "name of the body: car-body, bogie-1, bogie-2, wheelset-1 to wheelset-4",
       TextKey{of_load<&LoadParameters::body>, nullptr}},
      {"load.coach", "1", "counted from the front; 0: every one", IntegerKey{of_load<&LoadParameters::coach>, 0, 100}},
      {"load.file", "", "history over time or position; not together with the six components",
       FileKey{of_load<&LoadParameters::file>}},
      {"load.Fx", "N", "force forward at the centre of gravity", OptionalNumberKey{load_component<0>, {-1e8, 1e8}}},
      {"load.Fy", "N", "force to the right", OptionalNumberKey{load_component<1>, {-1e8, 1e8}}},
      {"load.Fz", "N", "force down", OptionalNumberKey{load_component<2>, {-1e8, 1e8}}},
      {"load.Mx", "N m", "moment about x", OptionalNumberKey{load_component<3>, {-1e9, 1e9}}},
      {"load.My", "N m", "moment about y", OptionalNumberKey{load_component<4>, {-1e9, 1e9}}},
      {"load.Mz", "N m", "moment about z", OptionalNumberKey{load_component<5>, {-1e9, 1e9}}},
      {"load.start", "s", "begin of the gust, or added to the times (positions, in m) of the file",
       NumberKey{of_load<&LoadParameters::start>, {-1e6, 1e6}}},
      {"load.gust_duration", "s", "of a one-minus-cosine gust with the components as its peak; 0: they are constant",
       NumberKey{of_load<&LoadParameters::gust_duration>, {0.0, 1e5}}},
  };
}

std::vector<KeyBinding> ground_keys() {
  return {
      {"ground_motion.file", "", "record of the ground's acceleration or displacement",
       FileKey{of_ground<&GroundMotionParameters::file>}},
      {"ground_motion.x", "m", "place of the record along the track, where there are several",
       NumberKey{of_ground<&GroundMotionParameters::x>, {-1e6, 1e6}}},
      {"ground_motion.factor", "1", "times the record",
       NumberKey{of_ground<&GroundMotionParameters::factor>, {-1e4, 1e4}}},
      {"ground_motion.start", "s", "added to the times of the record",
       NumberKey{of_ground<&GroundMotionParameters::start>, {0.0, 1e5}}},
      {"ground_motion.wave_speed", "m/s",
       "of a single record that travels along the track at 10 m/s or more, backward where negative; 0: it is "
       "everywhere alike",
       NumberKey{of_ground<&GroundMotionParameters::wave_speed>, {-1e5, 1e5}}},
  };
}

}  // namespace

const std::vector<KeyBinding>& load_keys() {
  static const std::vector<KeyBinding> keys = [] {
    std::vector<KeyBinding> all = deviation_keys();
    for (const auto& part : {body_load_keys(), ground_keys()}) all.insert(all.end(), part.begin(), part.end());
    return all;
  }();
  return keys;
}

}  // namespace railtab::scene
