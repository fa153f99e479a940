// SPDX-License-Identifier: Apache-2.0
// mercury import: robots from files of other simulators.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>

#include "app/base/file_name.h"
#include "app/base/interrupt.h"
#include "app/base/messages.h"
#include "app/base/progress.h"
#include "app/base/version.h"
#include "app/commands/description.h"
#include "app/commands/info_json.h"
#include "app/options/command.h"
#include "app/options/option_values.h"
#include "app/options/output_options.h"
#include "app/recording/trajectory_writer.h"
#include "mercury/error.h"
#include "mercury/import.h"
#include "mercury/robot_file.h"

namespace mercury {
namespace {

namespace fs = std::filesystem;

struct ImportCommandOptions {
  std::vector<std::string> paths;
  std::string output, format = "json", base;
  bool recursive = false, keep_going = false, json = false, brief = false;
  ImportOptions reading;
  OutputOptions outputs;
};

// A file with its robots, and the names of the files to write.
struct ImportedFile {
  Import import;
  std::vector<std::string> robot_files;
  std::string configuration_file;
  std::string recording_file;  // of a motion, which has no robots to simulate
};

// The files of a folder that can be imported, sorted by name; those on which others build are left out.
void add_files_of(const fs::path& folder, bool recursive, std::vector<fs::path>& files) {
  std::vector<fs::path> own, folders;
  std::error_code error;
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error)) {
    std::error_code ignored;
    if (!entry->is_directory(ignored))
      own.push_back(entry->path());
    else if (!entry->is_symlink(ignored))
      folders.push_back(entry->path());
  }
  if (error) throw InputError(folder.string(), error.message());
  const auto has = [&](std::string_view extension) {
    return std::ranges::any_of(own, [&](const fs::path& file) { return extension_of(file) == extension; });
  };
  std::ranges::sort(own);
  const auto others = std::ranges::count_if(own, [](const fs::path& f) { return extension_of(f) == ".rsc"; });
  for (const fs::path& file : own) {
    if (!import_format_of(file)) continue;
    const bool builds = extension_of(file) == ".rsc" ? others > 1 : has(".vxd");
    if (is_import_base(file) && builds)
      say_detail(fmt::format("{}: the base of the files beside it", file.string()));
    else
      files.push_back(file);
  }
  if (!recursive) return;
  std::ranges::sort(folders);
  for (const fs::path& inner : folders) add_files_of(inner, recursive, files);
}

std::vector<fs::path> files_in(const ImportCommandOptions& options) {
  std::vector<fs::path> files;
  for (const fs::path path : options.paths) {
    std::error_code ignored;
    if (!fs::is_directory(path, ignored)) {
      files.push_back(path);
      continue;
    }
    const std::size_t before = files.size();
    add_files_of(path, options.recursive, files);
    if (files.size() == before) throw InputError(path.string(), "the folder holds no file of " + import_sources());
  }
  return files;
}

std::vector<ImportedFile> read(const ImportCommandOptions& options, const std::vector<fs::path>& files,
                               bool& complete) {
  std::vector<ImportedFile> imports;
  Progress progress("importing", "files", static_cast<std::int64_t>(files.size()));
  progress.show();
  for (std::size_t i = 0; i < files.size(); ++i) {
    throw_if_interrupted();
    try {
      imports.push_back({import_file(files[i], options.reading), {}, {}, {}});
    } catch (const ParameterError&) {
      throw;
    } catch (const InputError& error) {
      if (!options.keep_going) throw;
      complete = false;
      warn(fmt::format("left out: {}", error.what()));
    }
    progress.update(static_cast<std::int64_t>(i + 1));
  }
  if (imports.empty()) throw InputError("no file is left that can be imported");
  return imports;
}

void name_files(std::vector<ImportedFile>& imports, const ImportCommandOptions& options) {
  FileNames robots, configurations, recordings;
  configurations.of("import");
  for (ImportedFile& file : imports) {
    std::vector<std::string>& names = file.import.report.robots;
    for (std::size_t i = 0; i < file.import.robots.size(); ++i) {
      names[i] = robots.of(names[i]);
      file.import.robots[i].name = names[i];
      if (file.import.motion) continue;
      file.robot_files.push_back((fs::path(options.output) / (names[i] + "." + options.format)).string());
    }
    const std::string stem = fs::path(file.import.report.file).stem().string();
    if (file.import.motion)
      file.recording_file = (fs::path(options.output) / (recordings.of(stem) + ".h5")).string();
    else if (!file.import.robots.empty())
      file.configuration_file = (fs::path(options.output) / (configurations.of(stem) + ".toml")).string();
  }
}

// One configuration for all robots, if their worlds are alike: the smallest time step, the means of damping and drag,
// which depend on the robot.
std::optional<ImportedSettings> common_settings(const std::vector<ImportedFile>& imports) {
  std::vector<ImportedSettings> all;
  for (const ImportedFile& file : imports)
    if (!file.robot_files.empty()) all.push_back(file.import.settings);
  if (all.size() < 2) return std::nullopt;
  ImportedSettings common = all.front();
  common.damping = common.drag_coefficient = 0;
  common.seconds.reset();
  common.settle.reset();
  for (const ImportedSettings& settings : all) {
    if (settings.environment != common.environment || settings.gravity != common.gravity ||
        settings.friction != common.friction || settings.static_friction != common.static_friction ||
        settings.self_collision != common.self_collision)
      return std::nullopt;
    const double share = 1 / static_cast<double>(all.size());
    common.dt = std::min(common.dt, settings.dt);
    common.damping += share * settings.damping;
    common.drag_coefficient += share * settings.drag_coefficient;
  }
  return common;
}

void print_report(const ImportReport& report, bool brief) {
  fmt::print("{}: {}{}\n", printable(report.file, 10000), report.format,
             report.base.empty() ? "" : fmt::format(", on the base {}", printable(report.base, 10000)));
  std::map<ImportOutcome, std::size_t> count;
  std::size_t place = 7, value = 5;
  for (const ImportedElement& element : report.elements) {
    ++count[element.outcome];
    place = std::min<std::size_t>(72, std::max(place, element.place.size()));
    value = std::min<std::size_t>(32, std::max(value, element.value.size()));
  }
  fmt::print("  {} element{}: {} mapped, {} approximated, {} ignored\n", report.elements.size(),
             report.elements.size() == 1 ? "" : "s", count[ImportOutcome::mapped], count[ImportOutcome::approximated],
             count[ImportOutcome::ignored]);
  fmt::print("  scale: 1 m there is {:.4g} m here, 1 s there is {:.4g} s here\n", report.length_scale,
             report.time_scale);
  for (const std::string& note : report.decisive) fmt::print("  {}\n", printable(note));
  for (const std::string& note : report.notes) fmt::print("  note: {}\n", printable(note));
  if (brief) return;
  for (const ImportedElement& element : report.elements)
    fmt::print("  {:<{}}  {:<{}}  {:<12}  {}\n", printable(element.place), place, printable(element.value, 32), value,
               name_of(element.outcome), printable(element.reason));
}

nlohmann::ordered_json json_of(const ImportedFile& file) {
  const ImportReport& report = file.import.report;
  nlohmann::ordered_json elements = nlohmann::ordered_json::array();
  for (const ImportedElement& element : report.elements)
    elements.push_back({{"place", element.place},
                        {"value", element.value},
                        {"outcome", name_of(element.outcome)},
                        {"reason", element.reason}});
  nlohmann::ordered_json json;
  json["file"] = report.file;
  json["format"] = report.format;
  json["base"] = text_or_null(report.base);
  json["robots"] = file.robot_files;
  json["configuration"] = text_or_null(file.configuration_file);
  json["length_scale"] = report.length_scale;
  json["time_scale"] = report.time_scale;
  json["recording"] = text_or_null(file.recording_file);
  json["decisive"] = report.decisive;
  json["notes"] = report.notes;
  json["elements"] = std::move(elements);
  return json;
}

void print_json(const std::vector<ImportedFile>& imports, const std::string& common) {
  nlohmann::ordered_json json;
  json["program"] = program_version;
  json["configuration"] = text_or_null(common);
  json["files"] = nlohmann::ordered_json::array();
  for (const ImportedFile& file : imports) json["files"].push_back(json_of(file));
  fmt::print("{}\n", json.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace));
}

void print_reports(const std::vector<ImportedFile>& imports, const std::string& common,
                   const ImportCommandOptions& options) {
  if (options.json) return print_json(imports, common);
  for (const ImportedFile& file : imports) {
    print_report(file.import.report, options.brief);
    for (const std::string& robot : file.robot_files) fmt::print("  wrote {}\n", printable(robot, 10000));
    for (const std::string& other : {file.configuration_file, file.recording_file})
      if (!other.empty()) fmt::print("  wrote {}\n", printable(other, 10000));
  }
  if (!common.empty()) fmt::print("for all robots: {}\n", printable(common, 10000));
}

std::string common_toml(const ImportedSettings& settings, const std::vector<ImportedFile>& imports) {
  ImportReport report = imports.front().import.report;
  report.file = fmt::format("{} files", imports.size());
  return to_toml(settings, report);
}

// Whether all files may be written. Returns the number of robots.
std::size_t add_outputs(OutputFiles& outputs, const std::vector<ImportedFile>& imports, const std::string& common,
                        const ImportCommandOptions& options) {
  std::size_t robots = 0, done = 0;
  for (const ImportedFile& file : imports) robots += file.robot_files.size();
  Progress progress("checking", "outputs", static_cast<std::int64_t>(robots));
  for (const ImportedFile& file : imports) {
    for (const std::string& robot : file.robot_files) {
      throw_if_interrupted();
      outputs.add_stream("-o", robot, options.output);
      progress.update(static_cast<std::int64_t>(++done));
    }
    if (!file.configuration_file.empty()) outputs.add_stream("-o", file.configuration_file, options.output);
    if (!file.recording_file.empty()) outputs.add_stream("-o", file.recording_file, options.output);
  }
  if (!common.empty()) outputs.add_stream("-o", common, options.output);
  outputs.check();
  return robots;
}

// Writes a file. Returns whether it has its name, see name_given().
bool writes(const std::string& file, const std::function<void()>& write) { return name_given(file, write) == file; }

bool write_robots(const std::vector<ImportedFile>& imports, std::size_t count) {
  Progress progress("writing", "robots", static_cast<std::int64_t>(count));
  std::int64_t written = 0;
  bool named = true;
  for (const ImportedFile& file : imports)
    for (std::size_t i = 0; i < file.robot_files.size(); ++i) {
      throw_if_interrupted();
      named &= writes(file.robot_files[i], [&] { save_robot(file.robot_files[i], file.import.robots[i]); });
      progress.update(++written);
    }
  return named;
}

// A recording of a motion that another program simulated.
void write_motion(const Import& import, const std::string& path) {
  const ImportedMotion& motion = *import.motion;
  std::vector<const Robot*> robots;
  std::vector<Material> materials;
  for (const Robot& robot : import.robots) {
    robots.push_back(&robot);
    materials.insert(materials.end(), robot.materials.begin(), robot.materials.end());
    materials.resize(robots.size() * max_materials);
  }
  const double length = motion.times.back() - motion.times.front();
  const double interval = motion.times.size() > 1 ? length / static_cast<double>(motion.times.size() - 1) : 1e-3;
  Configuration configuration{.dt = std::min(interval, 1e-3),
                              .environment = environment_named(import.settings.environment)};
  const auto step_at = [&](double time) { return std::llround((time - motion.times.front()) / configuration.dt); };
  TrajectoryWriter writer(path,
                          {.configuration = configuration,
                           .device_name = import.report.format,
                           .every = std::max<std::int64_t>(1, std::llround(interval / configuration.dt)),
                           .expected_frames = static_cast<std::int64_t>(motion.times.size()),
                           .watch = shown_work()},
                          robots, materials, "-o");
  std::int64_t last = -1;
  for (std::size_t frame = 0; frame < motion.times.size(); ++frame) {
    last = std::max<std::int64_t>(last + 1, step_at(motion.times[frame]));
    const TrajectoryWriter::Frame into = writer.add(last, motion.times[frame] - motion.times.front());
    std::ranges::copy(motion.positions[frame], into.positions.begin());
    // Of the way since the frame before, or to the next one.
    const std::size_t from = frame > 0 ? frame - 1 : 0,
                      to = std::min(std::max<std::size_t>(frame, 1), motion.times.size() - 1);
    const double span = motion.times[to] - motion.times[from];
    for (std::size_t mass = 0; mass < into.velocities.size(); ++mass)
      into.velocities[mass] =
          span > 0 ? static_cast<float>(1 / span) * (motion.positions[to][mass] - motion.positions[from][mass])
                   : Vec3{};
    writer.commit();
  }
  writer.finish({});
}

int import_files(ImportCommandOptions options) {
  options.reading.base = options.base;
  validate(options.reading);
  if (options.paths.empty()) throw InputError("give files or folders to import");
  bool complete = true;
  const std::vector<fs::path> files = files_in(options);
  OutputFiles outputs = options.outputs.files();
  for (const fs::path& file : files) outputs.add_input(file);
  outputs.add_folder("-o", options.output);
  outputs.check();  // the folder, before the work
  std::vector<ImportedFile> imports = read(options, files, complete);
  name_files(imports, options);
  const std::optional<ImportedSettings> settings = common_settings(imports);
  const std::string common = settings ? (fs::path(options.output) / "import.toml").string() : "";
  const std::size_t robots = add_outputs(outputs, imports, common, options);
  if (options.outputs.dry_run())
    return print_dry_run(
        "import",
        {{"files", fmt::to_string(imports.size())}, {"robots", fmt::to_string(robots)}, {"write", options.output}});
  const bool nothing =
      std::ranges::all_of(imports, [](const ImportedFile& file) { return file.import.robots.empty(); });
  if (!nothing) outputs.make_folders();
  complete &= write_robots(imports, robots);
  for (const ImportedFile& file : imports) {
    if (!file.configuration_file.empty())
      complete &= writes(file.configuration_file, [&] {
        write_results(file.configuration_file, to_toml(file.import.settings, file.import.report));
      });
    if (!file.recording_file.empty())
      complete &= writes(file.recording_file, [&] { write_motion(file.import, file.recording_file); });
    if (file.import.robots.empty())
      warn(fmt::format("{}: no robot in it: {}", printable(file.import.report.file), file.import.report.notes.front()));
  }
  if (!common.empty()) complete &= writes(common, [&] { write_results(common, common_toml(*settings, imports)); });
  print_reports(imports, common, options);
  if (nothing) warn("nothing was imported");
  return complete && !nothing ? 0 : 1;
}

}  // namespace

void add_import_command(const Command& program, const Choose& choose) {
  auto options = std::make_shared<ImportCommandOptions>();
  const Command command = program.add_command("import", "Make robots from files of other simulators");
  command.add_list("FILES", options->paths, "Files of " + import_sources() + ", and folders of them")
      .with_form("PATH")
      .required();
  add_text(command, "-o,--output", options->output, "Folder for the robots and their configurations", "FOLDER")
      .required();
  add_choice(command, "--format", options->format, {"json", "cbor"}, "Of the robot files (default json)");
  add_text(command, "--base", options->base,
           "File that a .vxd or .rsc builds on (default: base.vxa or env.rsc beside it)", "FILE")
      .on_first_screen();
  add_number(command, "--depth", options->reading.depth, "Thickness of flat robots of EvoGym in voxels (default 1)",
             "N");
  add_number(command, "--materials", options->reading.most_materials,
             "Most materials of a robot; with 22 or fewer its body can mutate and evolve (default 255)", "N");
  command.add_flag("--recursive", options->recursive, "Also import the folders inside folders").on_first_screen();
  command.add_flag("--keep-going", options->keep_going, "Report files that cannot be used, and go on (exit status 1)")
      .on_first_screen();
  command.add_flag("--brief", options->brief, "Print no line per element");
  command.add_flag("--json", options->json, "Print the report as JSON instead of a table").on_first_screen();
  options->outputs.add_to(command);
  command.set_footer(
      "Writes each robot as a robot file and, beside it, its world as a configuration (NAME.toml: environment, "
      "gravity,\n"
      "friction, time step). Prints what became of every element of the file: mapped, approximated or ignored, and "
      "why.\n"
      "If the worlds of several files agree, import.toml serves all robots.\n\n"
      "Examples:\n"
      "  mercury import hopper.vxa -o robots\n"
      "  mercury run robots/hopper.json --config robots/hopper.toml\n"
      "  mercury import generation-12/ -o robots --keep-going --json > report.json\n"
      "  mercury import robot.vxd --base base.vxa -o robots --materials 22\n"
      "  mercury import world.json -o robots --depth 3");
  command.when_chosen([options, choose] { choose([options] { return import_files(*options); }); });
}

}  // namespace mercury
