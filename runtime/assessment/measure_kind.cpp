#include "railtab/runtime/assessment/measure_kind.hpp"

namespace railtab {

std::string_view stage_name(AssessmentStage stage) noexcept {
  switch (stage) {
    case AssessmentStage::check:
      return "check";
    case AssessmentStage::moving_load:
      return "moving-load";
    case AssessmentStage::contact:
      break;
  }
  return "contact";
}

const std::vector<MeasureKind>& measure_kinds() {
  using enum AssessmentStage;
  static const std::vector<MeasureKind> kinds{
      {"first_frequency", "Hz", {check}, "first natural frequency of vertical bending"},
      {"lateral_frequency", "Hz", {check}, "first natural frequency of lateral bending"},
      {"deflection_lm71", "m", {check}, "largest deflection under load model 71 at rest, times Φ2"},
      {"deck_acceleration", "m/s2", {moving_load, contact}, "largest vertical acceleration of the deck, low-passed"},
      {"deck_acceleration_unfiltered", "m/s2", {contact}, "the same without a filter"},
      {"deck_displacement", "m", {moving_load, contact}, "largest vertical displacement of the deck"},
      {"deck_end_rotation",
       "rad",
       {moving_load, contact},
       "largest rotation of the deck's ends about the lateral axis"},
      {"deck_twist", "m", {contact}, "largest change of the deck's cross level over 3 m of the track"},
      {"track_twist", "m", {contact}, "largest twist over 3 m of the deck and of the track without traffic together"},
      {"horizontal_rotation", "rad", {contact}, "largest rotation of the deck's ends about the vertical axis"},
      {"deck_joint_step", "m", {contact}, "largest vertical offset of a deck's end against what adjoins it"},
      {"deck_joint_gap", "m", {contact}, "largest longitudinal displacement of a deck's end against what adjoins it"},
      {"wheel_unloading", "-", {contact}, "largest ΔQ/Q0, low-passed at 20 Hz"},
      {"wheel_unloading_unfiltered", "-", {contact}, "the same without a filter; 1 is lift-off"},
      {"unloading_duration", "s", {contact}, "longest time with ΔQ/Q0 above 0.6, unfiltered"},
      {"wheel_unloading_5ft", "-", {contact}, "largest ΔQ/Q0, low-passed at 20 Hz, mean over 5 ft (1.524 m)"},
      {"derailment_percentile",
       "-",
       {contact},
       "|Y/Q| of a wheel, low-passed at 20 Hz, mean over 2 m: 99.85 % of a section"},
      {"derailment_2m", "-", {contact}, "largest |Y/Q| of a wheel, low-passed at 20 Hz, mean over 2 m"},
      {"derailment_5ft", "-", {contact}, "the same, mean over 5 ft (1.524 m)"},
      {"derailment", "-", {contact}, "largest |Y/Q| of a wheel, low-passed at 20 Hz"},
      {"weinstock_sum", "-", {contact}, "largest |Y/Q| of both wheels of a wheelset together, low-passed at 20 Hz"},
      {"track_shift_percentile",
       "N",
       {contact},
       "|ΣY| of a wheelset, low-passed at 20 Hz, mean over 2 m: 99.85 % of a section"},
      {"track_shift_2m", "N", {contact}, "largest |ΣY| of a wheelset, low-passed at 20 Hz, mean over 2 m"},
      {"track_shift_5ft", "N", {contact}, "the same, mean over 5 ft (1.524 m)"},
      {"guiding_force_percentile", "N", {contact}, "|Y| of a wheel, low-passed at 20 Hz: 99.85 % of a section"},
      {"wheel_force_percentile", "N", {contact}, "Q, low-passed at 20 Hz: 99.85 % of a section"},
      {"wheel_force", "N", {contact}, "largest Q, low-passed at 20 Hz"},
      {"wear_number", "J/m", {contact}, "largest mean T·γ of a wheel: energy that creep takes per way"},
      {"rail_wear", "J/m", {contact}, "largest energy that creep of all wheels leaves in a metre of one rail"},
      {"contact_pressure", "Pa", {contact}, "largest normal pressure between wheel and rail"},
      {"car_body_vertical", "m/s2", {contact}, "largest vertical acceleration of a car body, unfiltered"},
      {"car_body_lateral", "m/s2", {contact}, "largest lateral acceleration of a car body, unfiltered"},
      {"car_body_vertical_6hz", "m/s2", {contact}, "largest vertical acceleration of a car body, low-passed at 6 Hz"},
      {"car_body_lateral_6hz", "m/s2", {contact}, "largest lateral acceleration of a car body, low-passed at 6 Hz"},
      {"comfort_vertical", "m/s2", {contact}, "largest rms of 5 s of a car body's vertical acceleration, weighted W_b"},
      {"comfort_lateral", "m/s2", {contact}, "largest rms of 5 s of a car body's lateral acceleration, weighted W_d"},
      {"comfort_longitudinal",
       "m/s2",
       {contact},
       "largest rms of 5 s of a car body's longitudinal acceleration, weighted W_d"},
      {"mean_comfort", "-", {contact}, "mean comfort N_MV of a car body over 5 minutes at least"},
      {"mean_comfort_seated", "-", {contact}, "mean comfort N_VA of seated passengers over 5 minutes at least"},
      {"mean_comfort_standing", "-", {contact}, "mean comfort N_VD of standing passengers over 5 minutes at least"},
      {"running_rms_vertical", "m/s2", {contact}, "largest rms of 1 s of a car body's vertical acceleration, W_k"},
      {"running_rms_lateral", "m/s2", {contact}, "largest rms of 1 s of a car body's lateral acceleration, W_d"},
      {"vibration_dose_vertical", "m/s1.75", {contact}, "vibration dose of a car body's vertical acceleration, W_k"},
      {"vibration_dose_lateral", "m/s1.75", {contact}, "vibration dose of a car body's lateral acceleration, W_d"},
      {"sperling_vertical", "-", {contact}, "largest W_z of 5 s of a car body, vertical"},
      {"sperling_lateral", "-", {contact}, "largest W_z of 5 s of a car body, lateral"},
  };
  return kinds;
}

const MeasureKind* find_measure(std::string_view name) {
  for (const MeasureKind& kind : measure_kinds()) {
    if (kind.name == name) return &kind;
  }
  return nullptr;
}

ShownUnit shown_unit(std::string_view unit) noexcept {
  constexpr double thousand = 1e3;
  if (unit == "m") return {"mm", thousand};
  if (unit == "N") return {"kN", 1.0 / thousand};
  if (unit == "Pa") return {"MPa", 1.0 / (thousand * thousand)};
  if (unit == "rad") return {"mrad", thousand};
  if (unit == "s") return {"ms", thousand};
  if (unit == "m/s2") return {"m/s²", 1.0};
  if (unit == "m/s1.75") return {"m/s^1.75", 1.0};
  if (unit == "-") return {"", 1.0};
  return {unit, 1.0};
}

}  // namespace railtab
