#include <pybind11/functional.h>
#include <pybind11/stl/filesystem.h>

#include <chrono>
#include <memory>

#include "bindings.hpp"
#include "headline.hpp"
#include "headline_text.hpp"
#include "railtab/runtime/scene/recorded_run.hpp"
#include "railtab/runtime/scene/scene_keys.hpp"
#include "railtab/runtime/scene/scene_parameters.hpp"
#include "rows.hpp"

namespace railtab::python {
namespace {

/// A record of its own for Python, with the names that stay the same.
struct Record {
  StepRecord step;
  std::shared_ptr<const ResultHeader> header;
};

/// Those who listen to a run; None is nobody.
struct Listeners {
  py::object step, progress, warning;
};

/// A run whose listeners are Python's. The run itself does not hold the interpreter's lock.
class ListenedRun {
 public:
  explicit ListenedRun(const Listeners& listeners) : listeners_(listeners) {}

  /// The run goes on from records that its file holds.
  void take_up(const RunResults& before, std::span<const StepRecord> records) {
    begin(before.header);
    for (const StepRecord& record : records) collector_->add(record);
  }

  [[nodiscard]] RunObserver observer() {
    const bool resumed = header_ != nullptr;
    RunObserver observer;
    observer.start = [this, resumed](const ResultHeader& header) {
      if (!resumed) begin(header);
    };
    observer.record = [this](const StepRecord& step) {
      collector_->add(step);
      if (!listeners_.step.is_none()) call(listeners_.step, Record{step, header_});
    };
    if (!listeners_.progress.is_none()) {
      observer.progress = [this](double fraction) {
        if (is_time(last_progress_)) call(listeners_.progress, fraction);
      };
    }
    observer.warning = [this](std::string_view warning) { call(listeners_.warning, std::string(warning)); };
    observer.stop = [this] { return stopped(); };
    return observer;
  }

  [[nodiscard]] report::Headline headline(const RunSummary& summary) const { return collector_->result(summary); }

  /// What a listener raised, StopIteration apart, which only ends the run.
  void raise() {
    if (error_) throw py::error_already_set(*error_);
  }

 private:
  void begin(const ResultHeader& header) {
    header_ = std::make_shared<const ResultHeader>(header);
    collector_.emplace(header);
  }

  static bool is_time(std::chrono::steady_clock::time_point& last) {
    const auto now = std::chrono::steady_clock::now();
    if (now - last < std::chrono::milliseconds(100)) return false;
    last = now;
    return true;
  }

  /// What Python raises ends the run after its step, with everything in the file.
  template <class... Arguments>
  void call(const py::object& listener, Arguments&&... arguments) {
    if (stop_) return;
    const py::gil_scoped_acquire lock;
    try {
      listener(std::forward<Arguments>(arguments)...);
    } catch (py::error_already_set& error) {
      stop_ = true;
      if (!error.matches(PyExc_StopIteration)) error_ = std::make_unique<py::error_already_set>(std::move(error));
    }
  }

  /// Also where Ctrl-C was pressed.
  bool stopped() {
    if (!stop_ && is_time(last_signal_)) {
      const py::gil_scoped_acquire lock;
      if (PyErr_CheckSignals() != 0) {
        stop_ = true;
        error_ = std::make_unique<py::error_already_set>();
      }
    }
    return stop_;
  }

  const Listeners& listeners_;
  std::shared_ptr<const ResultHeader> header_;
  std::optional<report::HeadlineCollector> collector_;
  std::unique_ptr<py::error_already_set> error_;
  std::chrono::steady_clock::time_point last_progress_, last_signal_;
  bool stop_ = false;
};

SceneParameters scene_of(const std::filesystem::path& file,
                         const std::vector<std::pair<std::string, std::string>>& changes) {
  std::vector<KeyChange> keys;
  for (const auto& [key, value] : changes) keys.push_back({key, value});
  return read_scene(file, keys);
}

std::string ended(const report::Headline& headline, const RunSummary& summary, const std::string& results) {
  nlohmann::ordered_json json = report::headline_json(headline, summary);
  json["interrupted"] = summary.interrupted;
  if (!results.empty()) json["results"] = results;
  return json.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
}

std::string run_to_file(const SceneParameters& scene, const std::filesystem::path& output, bool resume,
                        ListenedRun& listened) {
  RecordedRun run(scene, output, resume);
  if (run.is_complete()) return ended(report::headline_of(*run.before()), run.before()->summary, output.string());
  if (run.is_resumed()) listened.take_up(*run.before(), run.records_before());
  const RunSummary summary = run.run(listened.observer());
  return ended(listened.headline(summary), summary, run.has_results() ? output.string() : "");
}

/// @return the summary as JSON, with the keys of vsi run --json, interrupted, and results where there is a file
std::string run(const std::filesystem::path& scene_file,
                const std::vector<std::pair<std::string, std::string>>& changes,
                const std::optional<std::filesystem::path>& output, bool resume, const py::object& on_step,
                const py::object& on_progress, const py::object& on_warning) {
  const SceneParameters scene = scene_of(scene_file, changes);
  const Listeners listeners{on_step, on_progress, on_warning};
  ListenedRun listened(listeners);
  std::string result;
  try {
    const py::gil_scoped_release release;
    if (output) {
      require_results_place(*output, scene, scene_file);
      result = run_to_file(scene, *output, resume, listened);
    } else {
      const RunSummary summary = run_scene(scene, listened.observer());
      result = ended(listened.headline(summary), summary, "");
    }
  } catch (const InputError& wrong) {
    throw with_scene_line(wrong, scene, scene_file);
  }
  listened.raise();
  return result;
}

/// A view of a record's rows that keeps the record alive.
template <class T>
py::array_t<T> view(const py::object& record, const std::vector<T>& rows) {
  return py::array_t<T>(static_cast<py::ssize_t>(rows.size()), rows.data(), record);
}

void bind_record(py::module_& module) {
  PYBIND11_NUMPY_DTYPE(WheelRecord, Q, Y, X, patches, from_table, y_rail, y_wheel, angle, rolling_radius, normal_force,
                       penetration, second_y_rail, second_normal_force, wear_number, pressure);
  PYBIND11_NUMPY_DTYPE(MotionRecord, displacement, velocity, acceleration);
  py::class_<Record> record(module, "StepRecord",
                            "One instant of a run, as the results file records it; the arrays may be kept.");
  of_package(record);
  record.def_property_readonly(
      "time", [](const Record& r) { return r.step.time; }, "[s]");
  record.def_property_readonly(
      "position", [](const Record& r) { return r.step.position; }, "Of the first wheelset along the track [m].");
  record.def_property_readonly(
      "newton_iterations", [](const Record& r) { return r.step.newton_iterations; }, "Of the step.");
  record.def_property_readonly(
      "wheels", [](const py::object& r) { return view(r, r.cast<const Record&>().step.wheels); },
      R"(Structured array, shape (w,): left, right, front wheelset first; Q, Y, X [N] on the rail and the columns of the
    results' wheels/.)");
  record.def_property_readonly(
      "bodies", [](const py::object& r) { return view(r, r.cast<const Record&>().step.bodies); },
      "Structured array, shape (b,): displacement, velocity, acceleration, each (b, 6): x, y, z [m], roll, pitch, yaw "
      "[rad].");
  record.def_property_readonly(
      "nodes", [](const py::object& r) { return view(r, r.cast<const Record&>().step.nodes); },
      "Of the structure's recorded nodes, as bodies: shape (k,).");
  record.def_property_readonly(
      "body_names", [](const Record& r) { return r.header->body_names; }, "Names of the bodies, b of them.");
  record.def_property_readonly(
      "node_names", [](const Record& r) { return r.header->node_names; }, "Names of the nodes, k of them.");
}

}  // namespace

void bind_runs(py::module_& module) {
  bind_record(module);
  module.def("run_scene", &run, py::arg("scene"), py::arg("changes"), py::arg("output"), py::arg("resume"),
             py::arg("on_step"), py::arg("on_progress"), py::arg("on_warning"));
  module.def(
      "scene_keys",
      [] {
        using namespace py::literals;
        py::dict keys;
        for (const SceneKey& key : scene_keys()) {
          keys[py::str(key.path)] = py::dict("type"_a = key.type, "unit"_a = key.unit, "range"_a = key.range,
                                             "default"_a = key.default_value, "meaning"_a = key.meaning);
        }
        return keys;
      },
      "All keys of a scene: type, unit, range, default and meaning of each.");
}

}  // namespace railtab::python
