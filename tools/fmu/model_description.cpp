#include <fmt/format.h>

#include <iterator>
#include <string_view>

#include "fmu_file.hpp"
#include "railtab/fmi/track_variables.hpp"
#include "railtab/runtime/base/version.hpp"
#include "railtab/runtime/report/html_text.hpp"

namespace railtab::fmu {
namespace {

using report::escaped;

constexpr std::string_view rule =
    "Track and bridges without train. Inputs are values at the end of the communication step, which is the scene's "
    "time step or a multiple of it; outputs are those at its end. x points forward, y right, z down. Rails are rigid "
    "beyond the modelled track. Starts from the static equilibrium under the inputs of initialization mode.";

constexpr std::string_view units = R"(  <UnitDefinitions>
    <Unit name="m"><BaseUnit m="1"/></Unit>
    <Unit name="m/s"><BaseUnit m="1" s="-1"/></Unit>
    <Unit name="m/s2"><BaseUnit m="1" s="-2"/></Unit>
    <Unit name="rad"><BaseUnit rad="1"/></Unit>
    <Unit name="rad/s"><BaseUnit rad="1" s="-1"/></Unit>
    <Unit name="N"><BaseUnit kg="1" m="1" s="-2"/></Unit>
    <Unit name="N.m"><BaseUnit kg="1" m="2" s="-2"/></Unit>
  </UnitDefinitions>
)";

void add_head(const fmi::DrivenTrack& track, const std::string& guid, std::string& xml) {
  fmt::format_to(std::back_inserter(xml),
                 "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
                 "<fmiModelDescription fmiVersion=\"2.0\" modelName=\"{}\" guid=\"{}\" description=\"{}\" "
                 "license=\"Apache-2.0\" generationTool=\"railtab {}\" variableNamingConvention=\"structured\">\n"
                 "  <CoSimulation modelIdentifier=\"railtab_track\" canHandleVariableCommunicationStepSize=\"false\" "
                 "canInterpolateInputs=\"false\" maxOutputDerivativeOrder=\"0\" canRunAsynchronuously=\"false\" "
                 "canBeInstantiatedOnlyOncePerProcess=\"false\" canNotUseMemoryManagementFunctions=\"true\" "
                 "canGetAndSetFMUstate=\"true\" canSerializeFMUstate=\"true\" providesDirectionalDerivative=\"false\"/>"
                 "\n",
                 escaped(track.name), guid, rule, version());
}

void add_variable(const fmi::TrackVariable& variable, std::size_t reference, std::string& xml) {
  const bool input = variable.causality == fmi::Causality::input;
  fmt::format_to(std::back_inserter(xml),
                 "    <ScalarVariable name=\"{}\" valueReference=\"{}\" description=\"{}\" causality=\"{}\" "
                 "variability=\"continuous\"{}><Real unit=\"{}\"{}/></ScalarVariable>\n",
                 variable.name, reference, escaped(variable.description), input ? "input" : "output",
                 input ? "" : " initial=\"calculated\"", variable.unit,
                 input ? fmt::format(" start=\"{}\"", variable.start) : "");
}

// Outputs and those to be computed in initialization mode are the same; the index of a variable begins at 1.
void add_structure(const std::vector<fmi::TrackVariable>& variables, std::string& xml) {
  xml += "  <ModelStructure>\n";
  for (const std::string_view list : {"Outputs", "InitialUnknowns"}) {
    fmt::format_to(std::back_inserter(xml), "    <{}>\n", list);
    for (std::size_t i = 0; i < variables.size(); ++i) {
      if (variables[i].causality == fmi::Causality::input) continue;
      fmt::format_to(std::back_inserter(xml), "      <Unknown index=\"{}\"/>\n", i + 1);
    }
    fmt::format_to(std::back_inserter(xml), "    </{}>\n", list);
  }
  xml += "  </ModelStructure>\n";
}

}  // namespace

std::string model_description(const fmi::DrivenTrack& track, const std::string& guid) {
  const std::vector<fmi::TrackVariable> variables = fmi::track_variables(track);
  std::string xml;
  add_head(track, guid, xml);
  xml += units;
  xml += "  <LogCategories><Category name=\"logStatusError\" description=\"why a call failed\"/></LogCategories>\n";
  fmt::format_to(std::back_inserter(xml), "  <DefaultExperiment startTime=\"0\" stepSize=\"{}\"/>\n",
                 track.scheme.time_step);
  xml += "  <ModelVariables>\n";
  for (std::size_t i = 0; i < variables.size(); ++i) add_variable(variables[i], i, xml);
  xml += "  </ModelVariables>\n";
  add_structure(variables, xml);
  return xml + "</fmiModelDescription>\n";
}

}  // namespace railtab::fmu
