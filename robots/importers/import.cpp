// SPDX-License-Identifier: Apache-2.0
#include "mercury/import.h"

#include <fmt/format.h>
#include <algorithm>
#include <fstream>

#include "mercury/error.h"
#include "mercury/robot_file.h"
#include "robots/file/whole_file.h"
#include "robots/importers/report_builder.h"
#include "robots/importers/xml_document.h"

namespace mercury {

ImportFormat vxa_format();
ImportFormat vxd_format();
ImportFormat rsc_format();
ImportFormat evogym_format();
ImportFormat evogym_body_format();
ImportFormat history_format();

namespace {

namespace fs = std::filesystem;

// All formats. Each is described beside its reader.
const std::vector<ImportFormat>& formats() {
  static const std::vector<ImportFormat> all{vxa_format(), vxd_format(),    history_format(),
                                             rsc_format(), evogym_format(), evogym_body_format()};
  return all;
}

std::vector<std::string_view> words_of(std::string_view text) {
  std::vector<std::string_view> words;
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = std::min(text.find(' ', begin), text.size());
    words.push_back(text.substr(begin, end - begin));
    begin = end + 1;
  }
  return words;
}

std::string beginning_of(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::string text(4096, '\0');
  file.read(text.data(), static_cast<std::streamsize>(text.size()));
  text.resize(static_cast<std::size_t>(file.gcount()));
  return text;
}

// The base of a file: the one that was given, else the one beside it; empty = none.
fs::path base_of(const fs::path& path, const ImportFormat& format, const ImportOptions& options) {
  if (format.base_name.empty()) return {};
  if (!options.base.empty()) return options.base;
  const fs::path beside = path.parent_path() / format.base_name;
  std::error_code error;
  if (fs::exists(beside, error) && !fs::equivalent(beside, path, error)) return beside;
  if (!format.needs_base) return {};
  throw InputError(path.string(), fmt::format("a .{} changes a base, and no {} is beside it; name one with --base",
                                              format.name, format.base_name));
}

}  // namespace

void validate(const ImportOptions& options) {
  if (options.depth < 1 || options.depth > 100) throw ParameterError("depth", "give 1 to 100 voxels");
  if (options.most_materials < 8 || options.most_materials > 255)
    throw ParameterError("materials", "give 8 to 255 materials");
}

std::string import_sources() {
  struct Source {
    std::string_view programs;
    std::string extensions;
  };
  std::vector<Source> sources;
  for (const ImportFormat& format : formats()) {
    if (sources.empty() || sources.back().programs != format.programs) sources.push_back({format.programs, {}});
    for (const std::string_view extension : words_of(format.extensions))
      sources.back().extensions += (sources.back().extensions.empty() ? "" : ", ") + std::string(extension);
  }
  std::string text;
  for (std::size_t i = 0; i < sources.size(); ++i)
    text += fmt::format("{}{} ({})",
                        i == 0                    ? ""
                        : i + 1 == sources.size() ? " and "
                                                  : ", ",
                        sources[i].programs, sources[i].extensions);
  return text;
}

const ImportFormat* import_format_of(const fs::path& path) {
  const std::string extension = extension_of(path);
  for (const ImportFormat& format : formats()) {
    if (std::ranges::count(words_of(format.extensions), extension) == 0) continue;
    if (!format.recognizes) return &format;
    std::error_code error;
    if (fs::is_regular_file(path, error) && format.recognizes(beginning_of(path))) return &format;
  }
  return nullptr;
}

bool is_import_base(const fs::path& path) {
  return std::ranges::count(formats(), path.filename().string(), &ImportFormat::base_name) > 0;
}

Import import_text(std::string_view text, std::string_view format, const std::string& name,
                   const ImportOptions& options, std::string_view base) {
  validate(options);
  const auto found = std::ranges::find(formats(), format, &ImportFormat::name);
  if (found == formats().end()) throw ParameterError("format", fmt::format("\"{}\" is not accepted", format));
  return found->read(text, base, name, options);
}

Import import_file(const fs::path& path, const ImportOptions& options) {
  std::error_code error;
  if (!fs::exists(path, error) && !error) throw InputError(path.string(), "No such file or directory");
  const ImportFormat* format = import_format_of(path);
  if (!format) throw InputError(path.string(), "not a file of " + import_sources());
  return import_file(path, *format, options);
}

Import import_file(const fs::path& path, const ImportFormat& format, const ImportOptions& options) {
  validate(options);
  const std::string text = read_whole_file(path);
  const fs::path base = base_of(path, format, options);
  const std::string base_text = base.empty() ? std::string() : read_whole_file(base);
  try {
    Import import = format.read(text, base_text, path.stem().string(), options);
    import.report.file = path.string();
    import.report.base = base.string();
    return import;
  } catch (const ParameterError&) {
    throw;
  } catch (const InputError& problem) {
    throw InputError(path.string(), problem.what());
  }
}

std::string to_toml(const ImportedSettings& settings, const ImportReport& report) {
  std::string file;
  for (const char letter : report.file) file += static_cast<unsigned char>(letter) < ' ' ? ' ' : letter;
  std::string text = fmt::format("# World of {}, for mercury run, render and view --config.\n", file);
  text += fmt::format("# 1 m of the file is {:.4g} m here, 1 s is {:.4g} s.\n", report.length_scale, report.time_scale);
  text += fmt::format("environment = \"{}\"\ngravity = [0, 0, {:.9g}]\nstiffness-scale = {:.9g}\n",
                      settings.environment, settings.gravity, settings.stiffness_scale);
  if (settings.environment == "land") {
    text += fmt::format("friction = {:.9g}\n", settings.friction);
    if (settings.static_friction > 0) text += fmt::format("static-friction = {:.9g}\n", settings.static_friction);
    if (settings.self_collision) text += fmt::format("contact-stiffness = {:.9g}\n", settings.contact_stiffness);
    if (settings.self_collision && settings.contact_distance != ImportedSettings{}.contact_distance)
      text += fmt::format("contact-distance = {:.6g}\n", settings.contact_distance);
    if (!settings.self_collision) text += "no-self-collision = true\n";
  } else if (settings.environment == "resistive") {
    text += fmt::format(
        "normal-coefficient = {:.9g}\ntangential-coefficient = 0\nadded-mass-coefficient = 0\none-sided = true\n",
        settings.drag_coefficient);
  } else {
    text += "point-drag = 0\n";
  }
  text += fmt::format("dt = {:.9g}\ndamping = {:.9g}\n", settings.dt, settings.damping);
  if (!settings.seconds && !settings.settle) return text;
  text += "\n[run]\n";
  if (settings.seconds) text += fmt::format("seconds = {:.9g}\n", *settings.seconds);
  if (settings.settle) text += fmt::format("settle = {:.9g}\n", *settings.settle);
  return text;
}

std::string_view name_of(ImportOutcome outcome) {
  switch (outcome) {
    case ImportOutcome::mapped:
      return "mapped";
    case ImportOutcome::approximated:
      return "approximated";
    case ImportOutcome::ignored:
      break;
  }
  return "ignored";
}

void add_bodies(const VoxelBody& grid, const std::string& name, const Provenance& provenance,
                const ImportOptions& options, Import& import, SpringRule rule, double relaxation_time) {
  const std::vector<VoxelBody> bodies = separate_bodies(grid);
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    const std::string own = i == 0 ? name : fmt::format("{}-{}", name, i + 1);
    Rounding rounding;
    import.robots.push_back(voxel_body_robot(
        bodies[i], own, provenance, static_cast<std::size_t>(options.most_materials), rounding, rule, relaxation_time));
    fix_masses(import.robots.back(), bodies[i]);
    import.report.robots.push_back(own);
    if (!rounding.is_exact()) import.report.notes.push_back(fmt::format("{}: {}", own, text_of(rounding)));
  }
  if (bodies.size() > 1)
    import.report.notes.push_back(fmt::format(
        "{} separate bodies became a robot each; robots of Mercury do not touch each other", bodies.size()));
}

std::vector<std::string_view> list_values(std::string_view text) {
  std::vector<std::string_view> values;
  const bool commas = text.find(',') != std::string_view::npos;
  constexpr std::string_view spaces = " \t\r\n";
  for (std::size_t begin = 0; begin < text.size();) {
    std::size_t end = commas ? text.find(',', begin) : text.find_first_of(spaces, begin);
    end = std::min(end, text.size());
    const std::string_view value = trimmed(text.substr(begin, end - begin));
    begin = end + 1;
    if (value.empty() && (!commas || begin >= text.size())) continue;  // between spaces, or after a last comma
    values.push_back(value);
  }
  return values;
}

}  // namespace mercury
