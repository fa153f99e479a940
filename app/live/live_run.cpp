// SPDX-License-Identifier: Apache-2.0
#include "app/live/live_run.h"

#include <fmt/format.h>
#include <signal.h>
#include <stdlib.h>

#include <cerrno>
#include <chrono>
#include <exception>
#include <system_error>
#include <thread>
#include <utility>

#include "app/live/background.h"
#include "app/live/command_text.h"
#include "app/live/robot_saving.h"
#include "app/live/scene_document.h"
#include "app/live/stepping.h"
#include "mercury/robot_file.h"

namespace mercury {
namespace {

namespace fs = std::filesystem;

constexpr double interval = 0.5;     // between two looks at the folder [s]
constexpr double long_interval = 3;  // while it cannot be read [s]

// What the background has read.
struct Reading {
  std::shared_ptr<const RunView> view;  // null: nothing new
  std::string problem;
};

std::string folder_name(const fs::path& folder) {
  const fs::path name = folder.has_filename() ? folder.filename() : folder.parent_path().filename();
  return name.string();
}

// One file per robot, numbered, so that their order stays.
void write_founders(const std::vector<LiveRobot>& founders, const fs::path& folder) {
  std::vector<FileToSave> files;
  for (std::size_t i = 0; i < founders.size(); ++i)
    files.push_back({folder / fmt::format("{:04}-{}.json", i, file_name_of(founders[i].name)),
                     serialize_robot(whole_robot(founders[i]), RobotFormat::json)});
  if (const SaveResult result = save_files(files, false); !result.ok()) throw std::runtime_error(result.message);
}

namespace fs = std::filesystem;

constexpr auto most_patience = std::chrono::seconds(10);  // with a process that was asked to stop

// The last line that has text. Lines of progress end with a carriage return.
std::string last_line(const std::string& text) {
  const std::size_t end = text.find_last_not_of("\r\n ");
  if (end == std::string::npos) return {};
  const std::size_t before = text.find_last_of("\r\n", end);
  return text.substr(before == std::string::npos ? 0 : before + 1,
                     end - (before == std::string::npos ? 0 : before + 1) + 1);
}

}  // namespace

struct LiveRun::Parts {
  explicit Parts(fs::path path) : program(std::move(path)), background(messages) {}

  fs::path program;
  Messages messages;

  fs::path folder;                    // empty = no run is open
  std::shared_ptr<RunReader> reader;  // used by the background only
  std::shared_ptr<const RunView> view;
  std::string problem;
  std::optional<Family> family;
  std::optional<std::pair<std::uint64_t, std::shared_ptr<const Robot>>> body;  // asked for last; null while it grows
  Show show;                                                                   // to be called once
  bool reading = false;
  double read_at = 0;  // [s]

  Activity activity = Activity::none;
  fs::path evolving;  // folder of the process's run
  std::unique_ptr<TemporaryFolder> founders;
  std::unique_ptr<EvolutionProcess> process;

  Background background;  // last: its tasks end before the members that they use

  void open(const fs::path& path);
  void begin_reading();
  void take(Reading reading);
  void show_best();
  void start(const std::vector<std::string>& arguments);
  void watch_process();
};

LiveRun::LiveRun(fs::path program) : parts_(std::make_unique<Parts>(std::move(program))) {}
LiveRun::~LiveRun() = default;

std::vector<Message> LiveRun::take_messages() { return parts_->messages.take(); }
bool LiveRun::is_open() const { return !parts_->folder.empty(); }
const fs::path& LiveRun::folder() const { return parts_->folder; }
std::string LiveRun::name() const { return folder_name(parts_->folder); }
std::shared_ptr<const RunView> LiveRun::view() const { return parts_->view; }
const std::string& LiveRun::problem() const { return parts_->problem; }
const Family* LiveRun::family() const { return parts_->family ? &*parts_->family : nullptr; }
LiveRun::Activity LiveRun::activity() const { return parts_->activity; }
const fs::path& LiveRun::evolving() const { return parts_->evolving; }

void LiveRun::frame() {
  Parts& parts = *parts_;
  parts.background.finish_done();
  parts.watch_process();
  const double pause = parts.problem.empty() ? interval : long_interval;
  if (is_open() && !parts.reading && wall_now() - parts.read_at > pause) parts.begin_reading();
}

void LiveRun::open(const fs::path& folder, Show show) {
  parts_->open(folder);
  parts_->show = std::move(show);
  parts_->begin_reading();
}

void LiveRun::refresh() {
  if (is_open() && !parts_->reading) parts_->begin_reading();
}

void LiveRun::wait() {
  do parts_->background.wait();
  while (parts_->background.finish_done());
}

void LiveRun::close() { parts_->open({}); }

void LiveRun::Parts::open(const fs::path& path) {
  folder = path;
  reader = std::make_shared<RunReader>(path);
  view.reset();
  family.reset();
  body.reset();
  problem.clear();
  show = {};
  reading = false;
  read_at = 0;
}

// A run that the window's own process is about to make has no folder yet.
void LiveRun::Parts::begin_reading() {
  reading = true;
  const bool expected = activity != Activity::none && evolving == folder && !view;
  background.begin("reading " + folder_name(folder), 0,
                   [this, reader = reader, expected](WorkControl&) -> Background::Finish {
                     Reading result;
                     try {
                       if (!expected || is_run_folder(reader->folder())) result.view = reader->read();
                     } catch (const std::exception& error) {
                       result.problem = error.what();
                     }
                     return [this, reader, result] {
                       if (this->reader == reader) take(result);
                     };
                   });
}

void LiveRun::Parts::take(Reading result) {
  reading = false;
  read_at = wall_now();
  if (!result.problem.empty() && result.problem != problem) messages.add(Severity::error, result.problem);
  problem = std::move(result.problem);
  if (!result.view) return;
  if (view && view->opening != result.view->opening) body.reset();
  view = std::move(result.view);
  if (show && !view->best.empty()) show_best();
}

void LiveRun::Parts::show_best() {
  background.begin("growing the best robots", 0,
                   [this, reader = reader, view = view, show = std::exchange(show, {})](WorkControl&) {
                     auto robots = std::make_shared<std::vector<Robot>>();
                     for (const std::uint64_t id : view->best) robots->push_back(reader->grow(id));
                     return [robots, view, show] { show(std::move(*robots), *view); };
                   });
}

void LiveRun::read_family(std::uint64_t id) {
  if (!is_open()) return;
  Parts& parts = *parts_;
  parts.background.begin("reading a family", 0, [&parts, id, reader = parts.reader](WorkControl&) {
    return [&parts, reader, family = reader->family(id)] {
      if (parts.reader == reader) parts.family = family;
    };
  });
}

void LiveRun::grow(std::uint64_t id, std::function<void(Robot robot)> use) {
  if (!is_open()) return;
  parts_->background.begin("growing a robot", 0,
                           [id, reader = parts_->reader, use = std::move(use)](WorkControl&) -> Background::Finish {
                             auto robot = std::make_shared<Robot>(reader->grow(id));
                             return [robot, use] { use(std::move(*robot)); };
                           });
}

std::shared_ptr<const Robot> LiveRun::body_of(std::uint64_t id) {
  Parts& parts = *parts_;
  if (!is_open()) return nullptr;
  if (parts.body && parts.body->first == id) return parts.body->second;
  if (parts.body && !parts.body->second) return nullptr;  // another one grows
  parts.body.emplace(id, nullptr);
  parts.background.begin("growing a robot", 0, [&parts, id, reader = parts.reader](WorkControl&) -> Background::Finish {
    auto robot = std::make_shared<Robot>();
    try {
      *robot = reader->grow(id);
    } catch (const std::exception&) {  // the run's own problem is reported elsewhere
    }
    return [&parts, reader, id, robot] {
      if (parts.reader == reader) parts.body.emplace(id, robot);
    };
  });
  return nullptr;
}

void LiveRun::evolve(const EvolveRequest& request, std::vector<LiveRobot> founders) {
  Parts& parts = *parts_;
  if (parts.activity != Activity::none || founders.empty()) return;
  parts.activity = Activity::starting;
  parts.evolving = request.folder;
  parts.open(request.folder);
  try {
    parts.founders = std::make_unique<TemporaryFolder>();
  } catch (const std::exception& error) {
    parts.activity = Activity::none;
    parts.messages.add(Severity::error, error.what());
    return;
  }
  const std::vector<std::string> arguments = evolve_arguments(request, parts.founders->path());
  const auto task = [&parts, arguments, founders = std::move(founders)](WorkControl&) -> Background::Finish {
    std::string problem;
    try {
      write_founders(founders, parts.founders->path());
    } catch (const std::exception& error) {
      problem = error.what();
    }
    return [&parts, arguments, problem] {
      if (problem.empty()) {
        parts.start(arguments);
        return;
      }
      parts.activity = Activity::none;
      parts.problem = problem;
      parts.messages.add(Severity::error, problem);
    };
  };
  parts.background.begin("saving the founders", 0, task);
}

void LiveRun::resume(const Device& device, std::optional<int> generations) {
  if (parts_->activity != Activity::none || !is_open()) return;
  parts_->evolving = parts_->folder;
  std::vector<std::string> words{"evolve", parts_->folder.string(), "--resume", "--quiet",
                                 "--device=" + name_of(device)};
  if (generations) words.push_back(fmt::format("--generations={}", *generations));
  parts_->start(words);
}

void LiveRun::Parts::start(const std::vector<std::string>& arguments) {
  try {
    process = std::make_unique<EvolutionProcess>(program, arguments);
    activity = Activity::running;
  } catch (const std::exception& error) {
    activity = Activity::none;
    messages.add(Severity::error, fmt::format("{}: {}", program.string(), error.what()));
  }
}

void LiveRun::stop() {
  if (!parts_->process) return;
  parts_->process->stop();
  parts_->activity = Activity::stopping;
}

void LiveRun::leave_running() {
  if (parts_->process) parts_->process->leave_running();
  parts_->process.reset();
  parts_->activity = Activity::none;
}

void LiveRun::Parts::watch_process() {
  if (!process || process->running()) return;
  const std::string failure = process->failure(), name = folder_name(evolving);
  const bool made = is_run_folder(evolving);
  if (evolving == folder && !view && !made) {
    open({});
    problem = failure;
  }
  if (!failure.empty()) messages.add(Severity::error, failure);
  if (failure.empty() && process->stopped())
    messages.add(Severity::note, name + (made ? ": the evolution has stopped; \"Go on\" resumes it" : ": stopped"));
  else if (failure.empty())
    messages.add(Severity::note, name + ": the evolution is finished");
  process.reset();
  founders.reset();
  activity = Activity::none;
  read_at = 0;
}

std::vector<std::string> evolve_arguments(const EvolveRequest& request, const fs::path& founders) {
  std::vector<std::string> words{"evolve", request.folder.string(), "--from=" + founders.string(),
                                 "--genes=" + request.genes, "--quiet"};
  for (const auto& [option, value] : options_of(request.settings))
    words.push_back(value.empty() ? option : fmt::format("{}={}", option, value));
  return words;
}

fs::path this_program() {
  std::error_code error;
  const fs::path program = fs::read_symlink("/proc/self/exe", error);
  return error ? fs::path("mercury") : program;
}

TemporaryFolder::TemporaryFolder() {
  std::string name = (fs::temp_directory_path() / "mercury-XXXXXX").string();
  if (!mkdtemp(name.data())) throw std::system_error(errno, std::generic_category(), name);
  path_ = name;
}

TemporaryFolder::~TemporaryFolder() {
  std::error_code ignored;
  fs::remove_all(path_, ignored);
}

EvolutionProcess::~EvolutionProcess() {
  stop();
  const auto begin = std::chrono::steady_clock::now();
  while (running() && std::chrono::steady_clock::now() - begin < most_patience)
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
}

// SIGTERM does what SIGINT does (app/base/interrupt.h), and is not ignored in jobs of shell scripts.
void EvolutionProcess::stop() {
  if (!std::exchange(stopped_, true)) process_.signal(SIGTERM);
}

std::string EvolutionProcess::failure() {
  const int status = process_.finish();
  if (status == 0 || stopped_) return {};
  std::string line = last_line(process_.messages());
  if (line.starts_with("mercury: ")) line.erase(0, 9);
  return line.empty() ? "mercury evolve " + describe_exit(status) : line;
}

}  // namespace mercury
