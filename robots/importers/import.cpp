// SPDX-License-Identifier: Apache-2.0
#include "mercury/import.h"

#include <fmt/format.h>
#include <algorithm>
#include <array>
#include <cctype>
#include <fstream>
#include <utility>

#include "mercury/error.h"
#include "robots/file/whole_file.h"
#include "robots/importers/report_builder.h"

namespace mercury {
namespace {

namespace fs = std::filesystem;

std::string small_letters(std::string text) {
  std::ranges::transform(text, text.begin(), [](unsigned char letter) { return std::tolower(letter); });
  return text;
}

// The base of a .vxd or .rsc: the one that was given, else base.vxa or env.rsc beside it. A .rsc needs none.
fs::path base_of(const fs::path& path, ImportFormat format, const ImportOptions& options) {
  if (!options.base.empty()) return options.base;
  const fs::path beside = path.parent_path() / (format == ImportFormat::vxd ? "base.vxa" : "env.rsc");
  std::error_code error;
  if (fs::exists(beside, error) && !fs::equivalent(beside, path, error)) return beside;
  if (format == ImportFormat::rsc) return {};
  throw InputError(path.string(), "a .vxd changes a base, and no base.vxa is beside it; name one with --base");
}

}  // namespace

void validate(const ImportOptions& options) {
  if (options.depth < 1 || options.depth > 100) throw ParameterError("depth", "give 1 to 100 voxels");
  if (options.most_materials < 8 || options.most_materials > 255)
    throw ParameterError("materials", "give 8 to 255 materials");
}

std::optional<ImportFormat> import_format_of(const fs::path& path) {
  const std::string extension = small_letters(path.extension().string());
  if (extension == ".vxa" || extension == ".vxc") return ImportFormat::vxa;
  if (extension == ".vxd") return ImportFormat::vxd;
  if (extension == ".rsc") return ImportFormat::rsc;
  std::error_code error;
  if (extension != ".json" || !fs::is_regular_file(path, error)) return std::nullopt;
  // What decides is in the beginning of the files that EvoGym writes.
  std::ifstream file(path, std::ios::binary);
  std::array<char, 4096> beginning{};
  file.read(beginning.data(), beginning.size());
  const std::string_view text(beginning.data(), static_cast<std::size_t>(file.gcount()));
  return looks_like_evogym(text) ? std::optional(ImportFormat::evogym) : std::nullopt;
}

Import import_text(std::string_view text, ImportFormat format, const std::string& name, const ImportOptions& options,
                   std::string_view base) {
  validate(options);
  switch (format) {
    case ImportFormat::vxa:
      return import_vxa(text, name, options);
    case ImportFormat::vxd:
      return import_vxd(text, base, name, options);
    case ImportFormat::rsc:
      return import_rsc(text, base, name, options);
    case ImportFormat::evogym:
      break;
  }
  return import_evogym(text, name, options);
}

Import import_file(const fs::path& path, const ImportOptions& options) {
  std::error_code error;
  if (!fs::exists(path, error) && !error) throw InputError(path.string(), "No such file or directory");
  const std::optional<ImportFormat> format = import_format_of(path);
  if (!format)
    throw InputError(path.string(),
                     "not a file of VoxCAD, evosoro or voxcraft-sim (.vxa, .vxc, .vxd), of RISE (.rsc) or "
                     "of EvoGym (.json)");
  const std::string text = read_whole_file(path);
  fs::path base;
  std::string base_text;
  if (*format == ImportFormat::vxd || *format == ImportFormat::rsc) base = base_of(path, *format, options);
  if (!base.empty()) base_text = read_whole_file(base);
  try {
    Import import = import_text(text, *format, path.stem().string(), options, base_text);
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
    if (settings.self_collision)
      text += fmt::format("contact-stiffness = {:.9g}\n", settings.contact_stiffness);
    else
      text += "no-self-collision = true\n";
  } else if (settings.environment == "ocean") {
    text += fmt::format("drag-coefficient = {:.9g}\nlift-coefficient = {:.9g}\n", settings.drag_coefficient,
                        settings.lift_coefficient);
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
                const ImportOptions& options, Import& import) {
  const std::vector<VoxelBody> bodies = separate_bodies(grid);
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    const std::string own = i == 0 ? name : fmt::format("{}-{}", name, i + 1);
    Rounding rounding;
    import.robots.push_back(
        voxel_body_robot(bodies[i], own, provenance, static_cast<std::size_t>(options.most_materials), rounding));
    import.report.robots.push_back(own);
    if (!rounding.is_exact()) import.report.notes.push_back(fmt::format("{}: {}", own, text_of(rounding)));
  }
  if (bodies.size() > 1)
    import.report.notes.push_back(fmt::format(
        "{} separate bodies became a robot each; robots of Mercury do not touch each other", bodies.size()));
}

}  // namespace mercury
