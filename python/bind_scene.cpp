// kds._kds.Scene: scene files, read and run as the tool kds-collide does.
#include "examples/kds-collide/generator.hpp"
#include "io/event_csv.hpp"
#include "io/output_file.hpp"
#include "io/replay.hpp"
#include "io/run.hpp"
#include "io/scene_reader.hpp"
#include "io/stats_json.hpp"
#include "python/bindings.hpp"
#include "python/py_world.hpp"

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <list>
#include <optional>
#include <stdexcept>

namespace kds_python {
namespace {

namespace py = pybind11;
using namespace kds_collide;
using namespace kds::io;

/// Keeps the events of a run if they are wanted, bodies by their places in the scene. Lets Ctrl-C end it.
class Gatherer final : public EventSink {
 public:
  explicit Gatherer(bool wanted) : wanted_(wanted) {}
  void on_event(const Event& e) override {
    if (!wanted_) return;
    kds::collision::Contact contact{e.time, e.point, e.normal, e.feature_a, e.feature_b};
    rows.push_back(to_row(static_cast<std::int64_t>(e.kind), e.a, e.b, contact));
  }
  void on_time(double /*time*/) override {
    const py::gil_scoped_acquire acquire;
    if (PyErr_CheckSignals() != 0) throw py::error_already_set();
  }

  std::vector<EventRow> rows;

 private:
  bool wanted_;
};

/// Events and counters of a run; files appear when it has ended, all or none.
py::tuple run_scene(const Scene& scene, const std::string& broad_phase, double rate, int kdop, bool pairs,
                    std::size_t threads, std::size_t domains, double shortest_flight, double orientation_error,
                    bool gather, bool profile, const std::string& csv, const std::string& replay,
                    const std::string& title) {
  RunOptions options;
  options.broad_phase = broad_phase;
  options.rate = rate;
  options.kdop = kdop;
  options.pairs = pairs;
  options.threads = threads;
  options.domains = domains;
  options.shortest_flight = shortest_flight;
  options.orientation_error = orientation_error;
  options.profile = profile;
  options.steady_progress = broad_phase != "sap";  // whose frames would come more often
  Gatherer gatherer(gather);
  RunResult result;
  {
    const py::gil_scoped_release release;
    EventSinks sinks;
    std::optional<EventCsv> events;
    std::optional<OutputFile> page;
    std::optional<ReplayRecorder> recorder;
    sinks.add(gatherer);
    if (!csv.empty()) sinks.add(events.emplace(csv, scene));
    if (!replay.empty()) {
      replay_page("", default_three_folder());  // throws now if three.js is not there
      page.emplace(replay);
      sinks.add(recorder.emplace(scene));
    }
    result = run(scene, options, sinks);
    if (page) page->write(replay_page(recorder->to_json(title), default_three_folder()));
    if (events) events->close();
    if (page) page->close();
    if (events) events->commit();
    if (page) page->commit();
  }
  const auto rows = py::array_t<EventRow>(static_cast<py::ssize_t>(gatherer.rows.size()), gatherer.rows.data());
  return py::make_tuple(rows, to_json(result, options, 0), seconds_by_work(result.profile));
}

std::unique_ptr<PyWorld> make_scene_world(const Scene& scene, bool gather, const std::string& broad_phase,
                                          bool record) {
  kds::collision::WorldOptions options;
  options.start_time = scene.begin_time;
  options.response = scene.response;
  options.broad_phase = broad_phase_named(broad_phase);
  if (scene.domain && scene.domain->reflects) {
    options.walls = kds::collision::Walls{scene.domain->min, scene.domain->max, scene.domain->restitution};
  }
  auto world = hold_world({scene.degree(), scene.turning, 1, record}, options, gather);
  for (const SceneBody& body : scene.bodies) world->world().add_body(body);
  return world;
}

void generate(const std::string& file, const std::string& kind, std::size_t bodies, std::optional<double> density,
              std::uint64_t seed, std::optional<double> end_time) {
  GeneratorOptions options{kind, bodies, density, seed, end_time};
  const GeneratedScene scene = generate_scene(options);
  std::list<OutputFile> outputs;
  const std::filesystem::path path(file);
  for (const auto& mesh : scene.meshes) {
    outputs.emplace_back((path.parent_path() / mesh.name).string()).write(mesh.text);
  }
  outputs.emplace_back(file).write(scene.json);
  for (OutputFile& output : outputs) output.close();
  for (OutputFile& output : outputs) output.commit();
}

}  // namespace

void bind_scene(py::module_& module) {
  py::register_exception_translator([](std::exception_ptr thrown) {
    try {
      if (thrown) std::rethrow_exception(thrown);
    } catch (const SceneError& error) {
      PyErr_SetString(PyExc_ValueError, error.what());
    } catch (const OutputError& error) {
      PyErr_SetString(PyExc_OSError, error.what());
    } catch (const std::out_of_range& error) {  // a body that is not there
      PyErr_SetString(PyExc_ValueError, error.what());
    }
  });
  py::class_<Scene>(module, "Scene")
      .def_property_readonly("names",
                             [](const Scene& scene) {
                               std::vector<std::string> names;
                               for (const SceneBody& body : scene.bodies) names.push_back(body.name);
                               return names;
                             })
      .def_readonly("warnings", &Scene::warnings)
      .def_readonly("begin_time", &Scene::begin_time)
      .def_readonly("end_time", &Scene::end_time)
      .def_readonly("turning", &Scene::turning)
      .def_property_readonly("degree", &Scene::degree)
      .def("run", &run_scene)
      .def("world", &make_scene_world);
  module.def("read_scene",
             [](const std::string& file, std::optional<double> until) { return read_scene(file, until); });
  module.def("parse_scene", [](const std::string& text, const std::string& file, std::optional<double> until) {
    return parse_scene(text, file, until);
  });
  module.def("generate_scene", &generate);
}

}  // namespace kds_python
