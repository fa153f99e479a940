// SPDX-License-Identifier: Apache-2.0
// XDMF: a description of a recording, whose numbers stay in its HDF5 file. Two series, the skin and the springs, of the
// same masses. A frame is a slab of the recorded positions.
#include <fmt/format.h>

#include <string>
#include <system_error>

#include "app/export/writers.h"
#include "mercury/error.h"

namespace mercury {
namespace {

class XdmfWriter {
 public:
  XdmfWriter(OutputStream& file, const RecordedMotion& motion, const std::filesystem::path& path)
      : file_(file), motion_(motion) {
    // Readers look for it from the folder of the description.
    std::error_code error;
    std::filesystem::path recording = std::filesystem::proximate(
        motion.recording().path(), path.has_parent_path() ? path.parent_path() : std::filesystem::path("."), error);
    if (error) recording = std::filesystem::absolute(motion.recording().path());
    group_ = xml_text(fmt::format("{}:/particles/{}/", recording.string(), motion.group()));
  }

  void write(const Robot& robot) {
    masses_ = robot.masses.size();
    file_.text("<?xml version=\"1.0\"?>\n<Xdmf Version=\"3.0\">\n<Domain>\n");
    if (!robot.faces.empty())
      write_series("skin",
                   fmt::format("<Topology TopologyType=\"Triangle\" NumberOfElements=\"{}\">\n{}</Topology>\n",
                               robot.faces.size(), whole("UInt", 2, fmt::format("{} 3", robot.faces.size()), "faces")),
                   "");
    if (!robot.springs.empty()) {
      const std::string count = std::to_string(robot.springs.size());
      write_series("springs",
                   fmt::format("<Topology TopologyType=\"Polyline\" NodesPerElement=\"2\" NumberOfElements=\"{}\">\n{}"
                               "</Topology>\n",
                               count, whole("UInt", 2, count + " 2", "springs")),
                   attribute("material", "Scalar", "Cell", whole("UChar", 1, count, "spring_material")) +
                       attribute("rest length", "Scalar", "Cell", whole("Float", 4, count, "spring_rest_length")));
    }
    file_.text("</Domain>\n</Xdmf>\n");
  }

 private:
  void write_series(const char* name, const std::string& topology, const std::string& attributes) {
    file_.print("<Grid Name=\"{}\" GridType=\"Collection\" CollectionType=\"Temporal\">\n", name);
    for (std::size_t frame = 0; frame < motion_.frames(); ++frame) {
      file_.print("<Grid Name=\"{}\" GridType=\"Uniform\">\n<Time Value=\"{}\"/>\n{}", name, motion_.time(frame),
                  topology);
      file_.print("<Geometry GeometryType=\"XYZ\">\n{}</Geometry>\n", slab("position", frame));
      file_.print("{}{}</Grid>\n", attribute("velocity", "Vector", "Node", slab("velocity", frame)), attributes);
    }
    file_.text("</Grid>\n");
  }

  // A dataset beside the masses.
  std::string whole(const char* type, int bytes, const std::string& extent, const char* name) const {
    return fmt::format(
        "<DataItem Format=\"HDF\" NumberType=\"{}\" Precision=\"{}\" Dimensions=\"{}\">{}{}</DataItem>\n", type, bytes,
        extent, group_, name);
  }
  // A frame of an element: start, step and count along its three axes. VTK's reader takes the first node in a geometry
  // as the name of its numbers, and reads a geometry of another name again; the comment is that name.
  std::string slab(const char* element, std::size_t frame) const {
    return fmt::format(
        "<DataItem ItemType=\"HyperSlab\" Dimensions=\"{0} 3\"><!-- frame {1} -->\n"
        "<DataItem Format=\"XML\" NumberType=\"Int\" Dimensions=\"3 3\">{1} 0 0 1 1 1 1 {0} 3</DataItem>\n"
        "{2}</DataItem>\n",
        masses_, motion_.recorded_frame(frame),
        whole("Float", 4, fmt::format("{} {} 3", motion_.recording().frames(), masses_),
              fmt::format("{}/value", element).c_str()));
  }
  static std::string attribute(const char* name, const char* type, const char* center, const std::string& content) {
    return fmt::format("<Attribute Name=\"{}\" AttributeType=\"{}\" Center=\"{}\">\n{}</Attribute>\n", name, type,
                       center, content);
  }

  OutputStream& file_;
  const RecordedMotion& motion_;
  std::string group_;  // "swim.h5:/particles/eel/", as XML
  std::size_t masses_ = 0;
};

}  // namespace

void write_xdmf(const ExportedRobot& robot, RecordedMotion& motion, const std::filesystem::path& path,
                const ExportChoices& choices) {
  if (motion.recording().unfinished())
    throw InputError(motion.recording().path().string(),
                     "was not finished, and other programs do not open it; give another format");
  OutputStreams files;
  XdmfWriter(files.add(path), motion, path).write(robot.robot);
  choices.watch(motion.frames(), motion.frames());
  files.keep();
}

}  // namespace mercury
