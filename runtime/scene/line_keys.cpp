#include "railtab/runtime/scene/key_table.hpp"

namespace railtab::scene {
namespace {

template <auto member>
auto& of_spectrum(SceneDraft& draft) {
  return draft.spectrum.*member;
}
template <auto member>
auto& of_deviation(SceneDraft& draft) {
  return draft.deviation.*member;
}

std::string irregularity_left_out(const SceneParameters& scene) {
  return scene.irregularity || scene.spectrum ? "" : "irregularity: the scene has none";
}

ChoiceKey deviation_shapes() {
  using Shape = std::optional<SpanDeviationShape>;
  return choice<Shape>([](SceneDraft& d) -> Shape& { return d.deviation_shape; },
                       {{"none", Shape()},
                        {"bending", Shape(SpanDeviationShape::bending)},
                        {"parallel-shift", Shape(SpanDeviationShape::parallel_shift)}});
}

std::vector<KeyRow> track_quality_keys() {
  return all_of(
      {{{"irregularity.file",
         "",
         "measured deviations of both rails along x",
         FileKey{[](SceneDraft& d) -> std::filesystem::path& { return d.irregularity; }},
         {},
         {&irregularity_zero, &irregularity_outside_run, &irregularity_with_step, &irregularity_too_large},
         irregularity_left_out},
        {"irregularity.spectrum",
         "",
         "spectrum of a random track",
         TextKey{[](SceneDraft& d) -> std::string& { return d.spectrum_name; }, spectrum_names},
         {&without_irregularity_file}}},
       applying(with_spectrum,
                {{"irregularity.seed", "1", "seed", IntegerKey{of_spectrum<&SpectrumParameters::seed>, 0, 1000000000}},
                 {"irregularity.shortest_wave", "m", "shortest, longest wavelength",
                  NumberKey{of_spectrum<&SpectrumParameters::shortest>, {0.1, 500.0}}},
                 {"irregularity.longest_wave", "m", "shortest, longest wavelength",
                  NumberKey{of_spectrum<&SpectrumParameters::longest>, {0.1, 500.0}}},
                 {"irregularity.fade_in", "m",
                  "length from train.start over which it rises from zero; longest_wave by default",
                  OptionalNumberKey{of_spectrum<&SpectrumParameters::fade_in>, {0.0, 1e4}}}})});
}

std::vector<KeyRow> deviation_keys() {
  return {
      {"span_deviation.direction", "", "direction of the deviation",
       choice<SpanDeviationDirection>(
           of_deviation<&SpanDeviationParameters::direction>,
           {{"vertical", SpanDeviationDirection::vertical}, {"lateral", SpanDeviationDirection::lateral}})},
      {"span_deviation.span", "m", "length of a span",
       NumberKey{of_deviation<&SpanDeviationParameters::span>, {0.5, 1000.0}}},
      {"span_deviation.amplitude",
       "m",
       "largest deviation, down or to the right",
       NumberKey{of_deviation<&SpanDeviationParameters::amplitude>, {-0.5, 0.5}},
       {},
       {&deviation_zero}},
      {"span_deviation.start",
       "m",
       "start of the first span that turns",
       NumberKey{of_deviation<&SpanDeviationParameters::start>, {-1e6, 1e6}},
       {},
       {&deviation_outside_run}},
      {"span_deviation.beta", "1/m", "relative bending stiffness of rails and pads; 0: 1.387 vertical, 3.239 lateral",
       NumberKey{of_deviation<&SpanDeviationParameters::beta>, {0.01, 100.0, true}}},
  };
}

}  // namespace

std::vector<KeyRow> irregularity_keys() {
  return all_of({track_quality_keys(),
                 {{"span_deviation.shape", "", "shape of the rails", deviation_shapes()}},
                 applying(with_turning_spans, deviation_keys())});
}

}  // namespace railtab::scene
