// SPDX-License-Identifier: Apache-2.0
// XDMF: a description of a recording, whose numbers stay in its HDF5 file. Two series, the springs and the skin, of the
// same masses. Its frames have names in a small file beside (write_frame_links()): meshio knows no parts of a dataset.
// It takes the last series, and from each frame attributes alone, so that positions are one, too.
#include <fmt/format.h>

#include <string>
#include <system_error>
#include <vector>

#include "app/export/writers.h"
#include "app/recording/trajectory_layout.h"
#include "mercury/error.h"
#include "mercury/names.h"

namespace mercury {
namespace {

std::filesystem::path frame_links_beside(const std::filesystem::path& xdmf) {
  return std::filesystem::path(xdmf).replace_extension(".frames.h5");
}

std::string recording_seen_from(const RecordedMotion& motion, const std::filesystem::path& path) {
  std::error_code error;
  const std::filesystem::path recording = std::filesystem::proximate(
      motion.recording().path(), path.has_parent_path() ? path.parent_path() : std::filesystem::path("."), error);
  return (error ? std::filesystem::absolute(motion.recording().path()) : recording).string();
}

class XdmfWriter {
 public:
  XdmfWriter(OutputStream& file, const RecordedMotion& motion, const std::filesystem::path& path)
      : file_(file), motion_(motion) {
    // Readers look for it from the folder of the description.
    group_ = markup_text(fmt::format("{}:/particles/{}/", recording_seen_from(motion, path), motion.group()));
    frames_ = markup_text(frame_links_beside(path).filename().string() + ":/");
  }

  void write(const Robot& robot) {
    masses_ = robot.masses.size();
    file_.text("<?xml version=\"1.0\"?>\n<Xdmf Version=\"3.0\">\n<Domain>\n");
    if (!robot.springs.empty()) {
      const std::string count = std::to_string(robot.springs.size());
      write_series("springs",
                   fmt::format("<Topology TopologyType=\"Polyline\" NodesPerElement=\"2\" NumberOfElements=\"{}\">\n{}"
                               "</Topology>\n",
                               count, whole("UInt", 2, count + " 2", "springs")),
                   attribute("material", "Scalar", "Cell", whole("UChar", 1, count, "spring_material")) +
                       attribute("rest length", "Scalar", "Cell", whole("Float", 4, count, "spring_rest_length")));
    }
    if (!robot.faces.empty())
      write_series("skin",
                   fmt::format("<Topology TopologyType=\"Triangle\" NumberOfElements=\"{}\">\n{}</Topology>\n",
                               robot.faces.size(), whole("UInt", 2, fmt::format("{} 3", robot.faces.size()), "faces")),
                   "");
    file_.text("</Domain>\n</Xdmf>\n");
  }

 private:
  void write_series(const char* name, const std::string& topology, const std::string& attributes) {
    file_.print("<Grid Name=\"{}\" GridType=\"Collection\" CollectionType=\"Temporal\">\n", name);
    for (std::size_t frame = 0; frame < motion_.frames(); ++frame) {
      file_.print("<Grid Name=\"{}\" GridType=\"Uniform\">\n<Time Value=\"{}\"/>\n{}", name, motion_.time(frame),
                  topology);
      file_.print("<Geometry GeometryType=\"XYZ\">\n{}</Geometry>\n", of_frame("position", frame));
      for (const char* element : {"position", "velocity"})
        file_.text(attribute(element, "Vector", "Node", of_frame(element, frame)));
      file_.print("{}</Grid>\n", attributes);
    }
    file_.text("</Grid>\n");
  }

  // A dataset beside the masses.
  std::string whole(const char* type, int bytes, const std::string& extent, const char* name) const {
    return item(type, bytes, extent, group_ + name);
  }
  std::string of_frame(const char* element, std::size_t frame) const {
    return item("Float", 4, fmt::format("{} 3", masses_), fmt::format("{}{}/{}", frames_, element, frame));
  }
  static std::string item(const char* type, int bytes, const std::string& extent, const std::string& place) {
    return fmt::format("<DataItem Format=\"HDF\" NumberType=\"{}\" Precision=\"{}\" Dimensions=\"{}\">{}</DataItem>\n",
                       type, bytes, extent, place);
  }
  static std::string attribute(const char* name, const char* type, const char* center, const std::string& content) {
    return fmt::format("<Attribute Name=\"{}\" AttributeType=\"{}\" Center=\"{}\">\n{}</Attribute>\n", name, type,
                       center, content);
  }

  OutputStream& file_;
  const RecordedMotion& motion_;
  std::string group_;   // "swim.h5:/particles/eel/", as XML
  std::string frames_;  // "swim.frames.h5:/", as XML
  std::size_t masses_ = 0;
};

void write_description(const ExportedRobot& robot, RecordedMotion& motion, const std::filesystem::path& path,
                       const ExportChoices& choices) {
  std::vector<std::size_t> numbers;
  for (std::size_t frame = 0; frame < motion.frames(); ++frame) numbers.push_back(motion.recorded_frame(frame));
  OutputStreams files;
  XdmfWriter(files.add(path), motion, path).write(robot.robot);
  choices.watch(motion.frames(), motion.frames());  // the last chance to stop: what follows leaves both files
  files.close(beside_xdmf(path));
  write_frame_links(frame_links_beside(path),
                    {.recording = recording_seen_from(motion, path),
                     .group = motion.group(),
                     .frames = motion.recording().frames(),
                     .masses = robot.robot.masses.size()},
                    numbers);
  files.keep();
}

}  // namespace

std::vector<std::filesystem::path> beside_xdmf(const std::filesystem::path& xdmf) { return {frame_links_beside(xdmf)}; }

void write_xdmf(const ExportedRobot& robot, RecordedMotion& motion, const std::filesystem::path& path,
                const ExportChoices& choices) {
  if (motion.recording().unfinished())
    throw InputError(motion.recording().path().string(),
                     "was not finished, and other programs do not open it; give another format");
  write_together(path, beside_xdmf,
                 [&](const std::filesystem::path& name) { write_description(robot, motion, name, choices); });
}

}  // namespace mercury
