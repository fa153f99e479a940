// SPDX-License-Identifier: Apache-2.0
#include "mercury/import.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <fstream>

#include "mercury/error.h"
#include "robots/importers/report_builder.h"
#include "robots/whole_file.h"

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

}  // namespace mercury
