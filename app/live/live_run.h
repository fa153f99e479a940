// SPDX-License-Identifier: Apache-2.0
// The evolution that the window has open: its folder, read in the background again and again, and perhaps the process
// that evolves it.
//
//   mercury evolve RUN  --> run folder --> RunReader (background) --> RunView --> the window draws
//
// The process may be the window's own (evolve(), resume()) or that of somebody else, on this host or another.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/base/child_process.h"
#include "app/live/messages.h"
#include "app/live/run_view.h"
#include "app/live/snapshot.h"
#include "mercury/evolution.h"

namespace mercury {

// A new run that starts from robots of the window.
struct EvolveRequest {
  std::filesystem::path folder;  // of the run; new or empty
  std::string genes = "body";    // what changes: name_of(Genes)
  EvolutionSettings settings{.algorithm = {.population = 64}, .generations = 50};
};

// The words after `mercury`. `founders`: a folder of robot files.
std::vector<std::string> evolve_arguments(const EvolveRequest& request, const std::filesystem::path& founders);

// The file of the running program.
std::filesystem::path this_program();

// A folder of files that are needed for a while; the destructor removes it.
class TemporaryFolder {
 public:
  TemporaryFolder();  // throws std::system_error
  ~TemporaryFolder();
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

class EvolutionProcess {
 public:
  // Throws CannotStart.
  EvolutionProcess(const std::filesystem::path& program, const std::vector<std::string>& arguments)
      : process_(program.string(), arguments) {}
  ~EvolutionProcess();  // stops it and waits some seconds until it has; kills it after that

  bool running() { return process_.running(); }
  // Asks it to stop in an orderly way, as Ctrl-C does: the run can be resumed.
  void stop();
  bool stopped() const { return stopped_; }
  // It runs on when this object is destroyed.
  void leave_running() { process_.release(); }
  // Why it ended, in one line, if not by itself: its last message, or its exit status. Empty = it ended well.
  std::string failure();

 private:
  ChildProcess process_;
  bool stopped_ = false;
};

// All members are called from one thread. None waits, except wait() and the destructor, which stops the window's own
// process. Errors are reported by take_messages().
class LiveRun {
 public:
  // `program` evolves; it is this program, except in tests.
  explicit LiveRun(std::filesystem::path program = this_program());
  ~LiveRun();

  // Call it once per frame: takes over what was read, and begins to read again now and then.
  void frame();
  std::vector<Message> take_messages();

  // Opens a run folder in place of the one that is open. `show` is called with the best robots as soon as there is a
  // generation.
  using Show = std::function<void(std::vector<Robot> robots, const RunView& view)>;
  void open(const std::filesystem::path& folder, Show show = {});
  void close();
  bool is_open() const;
  const std::filesystem::path& folder() const;
  std::string name() const;  // of the folder
  void refresh();            // reads the folder now
  void wait();               // until all that was begun in the background has ended, and its results are taken over
  // As it was read last; null before the first time.
  std::shared_ptr<const RunView> view() const;
  // Why the folder cannot be read, or why the run that evolve() began was not made; empty = no problem.
  const std::string& problem() const;

  // Reads the family of an individual; family() returns the one read last, or null.
  void read_family(std::uint64_t id);
  const Family* family() const;
  // Grows the robot of an individual and then calls `use`, in a later frame().
  void grow(std::uint64_t id, std::function<void(Robot robot)> use);
  // The robot of an individual, for a picture: null until it is grown in the background, one individual at a time; a
  // robot without masses if it cannot be grown.
  std::shared_ptr<const Robot> body_of(std::uint64_t id);

  // The window's own process. evolve() and resume() do nothing while there is one.
  enum class Activity { none, starting, running, stopping };
  Activity activity() const;
  const std::filesystem::path& evolving() const;  // the folder of its run, which may be another than folder()
  // Starts a run from these robots and opens its folder.
  void evolve(const EvolveRequest& request, std::vector<LiveRobot> founders);
  // Continues the open run, to this number of generations if it is given.
  void resume(const Device& device, std::optional<int> generations = {});
  void stop();           // in an orderly way
  void leave_running();  // also when the window is closed

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace mercury
