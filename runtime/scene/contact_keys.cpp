#include "railtab/runtime/scene/key_table.hpp"

namespace railtab::scene {
namespace {

std::vector<std::string> creep_law_names() { return {"linear", "polach", "fastsim", "table"}; }

template <auto member>
auto& of_contact(SceneDraft& draft) {
  return draft.parameters.contact.*member;
}
template <auto member>
auto& of_dimensions(SceneDraft& draft) {
  return draft.parameters.contact.dimensions.*member;
}

std::string contact_search_left_out(const SceneParameters& scene) {
  if (scene.contact.normal == NormalContact::rigid || scene.contact.mode == ContactMode::table) return {};
  return "geometry table look-up: contact is searched in every iteration";
}
std::string contact_left_out(const SceneParameters& scene) {
  if (scene.contact.normal == NormalContact::hertz) return {};
  return "contact geometry, creep forces, loss of contact: contact.normal is \"rigid\"";
}

/// Profiles and dimensions, which a table has too.
std::vector<KeyRow> pair_keys() {
  return applying(without_contact_table,
                  {
                      {"contact.wheel",
                       "",
                       "wheel profile",
                       ProfileKey{of_contact<&ContactParameters::wheel>, ProfileKind::wheel},
                       {},
                       {&noisy_wheel_profile}},
                      {"contact.rail",
                       "",
                       "rail profile",
                       ProfileKey{of_contact<&ContactParameters::rail>, ProfileKind::rail},
                       {},
                       {&noisy_rail_profile}},
                      {"contact.rail_inclination",
                       "1",
                       "inclination of the rail",
                       RatioKey{of_contact<&ContactParameters::rail_inclination>, {0.0, 0.1}},
                       {&with_built_in_rail}},
                      {"contact.dimensions.track_gauge", "m", "distance of the gauge points",
                       NumberKey{of_dimensions<&PairDimensions::track_gauge>, {0.5, 2.0}}},
                      {"contact.dimensions.gauge_height", "m", "depth of the gauge points below the rail-head tops",
                       NumberKey{of_dimensions<&PairDimensions::gauge_height>, {0.0, 0.05}}},
                      {"contact.dimensions.flange_back", "m", "flange-back distance of the wheelset",
                       NumberKey{of_dimensions<&PairDimensions::flange_back>, {0.4, 2.0}}},
                      {"contact.dimensions.nominal_radius", "m", "wheel radius at the tape circle",
                       NumberKey{of_dimensions<&PairDimensions::nominal_radius>, {0.1, 1.0}}},
                  });
}

std::vector<KeyRow> force_keys() {
  return {
      {"contact.creep_law", "", "creep law; linear: without the bound of friction",
       TextKey{of_contact<&ContactParameters::creep_law>, creep_law_names}},
      {"contact.creep_table",
       "",
       "creep table; absent: the shipped one, for nu = 0.28",
       FileKey{of_contact<&ContactParameters::creep_table>},
       {&with_creep_table_law}},
      {"contact.friction",
       "1",
       "Coulomb friction coefficient",
       NumberKey{of_contact<&ContactParameters::friction>, {0.0, 2.0}},
       {&without_friction_file}},
      {"contact.friction_file", "", "friction coefficients of both rails",
       FileKey{of_contact<&ContactParameters::friction_file>}},
      {"contact.friction_limit", "1", "friction at high slip velocity over that without slip, A of Polach",
       NumberKey{[](SceneDraft& d) -> double& { return d.parameters.contact.friction_law.limit; }, {0.0, 1.0}}},
      {"contact.friction_decay", "s/m", "fall of friction with the slip velocity, B of Polach",
       NumberKey{[](SceneDraft& d) -> double& { return d.parameters.contact.friction_law.decay; }, {0.0, 1e3}}},
      {"contact.initial_slope", "1", "initial slope of creep force over creepage, over that of clean surfaces",
       NumberKey{[](SceneDraft& d) -> double& { return d.parameters.contact.friction_law.initial_slope; },
                 {1e-3, 1.0}}},
      {"contact.k_adhesion",
       "1",
       "reduction factors of the areas of adhesion and slip, k_A, k_S of Polach",
       NumberKey{of_contact<&ContactParameters::k_adhesion>, {1e-3, 1.0}},
       {&with_polach_law}},
      {"contact.k_slip",
       "1",
       "reduction factors of the areas of adhesion and slip, k_A, k_S of Polach",
       NumberKey{of_contact<&ContactParameters::k_slip>, {1e-3, 1.0}},
       {&with_polach_law}},
      {"contact.creep_speed_floor",
       "m/s",
       "least speed that creepages are relative to",
       NumberKey{of_contact<&ContactParameters::creep_speed_floor>, {1e-3, 1.0}},
       {&with_speed_file}},
      {"contact.damping", "s/m", "contact damping c of F_n·(1 + c·d'), d' the rate of penetration",
       NumberKey{of_contact<&ContactParameters::damping>, {0.0, 1e3}}},
      {"contact.curvature_floor", "1/m", "smallest relative lateral curvature of the Hertz ellipse",
       NumberKey{of_contact<&ContactParameters::curvature_floor>, {1e-6, 1e4}}},
      {"contact.material.E", "Pa", "Young's modulus of wheel and rail",
       NumberKey{[](SceneDraft& d) -> double& { return d.parameters.contact.material.E; }, {1e8, 1e15}}},
      {"contact.material.nu", "1", "Poisson's ratio of wheel and rail",
       NumberKey{[](SceneDraft& d) -> double& { return d.parameters.contact.material.nu; }, {0.0, 0.5}}},
  };
}

template <auto member>
auto& of_profiles(SceneDraft& draft) {
  return draft.profiles.*member;
}

}  // namespace

std::vector<KeyRow> profile_keys() {
  return applying(with_hertz_contact, {{"profiles.coach", "1", "counted from the front; 0: all",
                                        IntegerKey{of_profiles<&ProfileParameters::coach>, 0, 100}},
                                       {"profiles.vehicle", "", "vehicle as the train names it; absent: any",
                                        VehicleKey{of_profiles<&ProfileParameters::vehicle>}},
                                       {"profiles.table",
                                        "",
                                        "geometry table of these wheels",
                                        FileKey{of_profiles<&ProfileParameters::table>},
                                        {&with_contact_table}},
                                       {"profiles.wheel",
                                        "",
                                        "wheel profile of these wheels; absent: contact.wheel",
                                        ProfileKey{of_profiles<&ProfileParameters::wheel>, ProfileKind::wheel},
                                        {&without_contact_table}}});
}

std::vector<KeyRow> contact_keys() {
  std::vector<KeyRow> rows{{"contact.normal",
                            "",
                            "Hertz's theory, or wheels that follow the rails, vertically only and without lift-off",
                            choice<NormalContact>(of_contact<&ContactParameters::normal>,
                                                  {{"hertz", NormalContact::hertz}, {"rigid", NormalContact::rigid}}),
                            {},
                            {},
                            contact_left_out}};
  std::vector<KeyRow> hertz{
      {"contact.mode",
       "",
       "source of the contact points",
       choice<ContactMode>(
           of_contact<&ContactParameters::mode>,
           {{"table", ContactMode::table}, {"online", ContactMode::online}, {"paper", ContactMode::paper}}),
       {},
       {},
       contact_search_left_out},
      {"contact.table", "", "geometry table", FileKey{of_contact<&ContactParameters::table>}},
      {"contact.elastic",
       "",
       "forces by the loaded part of the table, or by an ellipse per patch; automatic: the former where present and "
       "certified to 5 %",
       choice<ElasticContact>(of_contact<&ContactParameters::elastic>, {{"automatic", ElasticContact::automatic},
                                                                        {"half-space", ElasticContact::half_space},
                                                                        {"patches", ElasticContact::patches}}),
       {&with_contact_table},
       {&inaccurate_loaded_table}}};
  return all_of({rows, applying(with_hertz_contact, all_of({hertz, pair_keys(), force_keys()}))});
}

}  // namespace railtab::scene
