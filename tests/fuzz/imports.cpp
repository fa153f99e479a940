// SPDX-License-Identifier: Apache-2.0
// Files of other simulators.
#include <cmath>

#include "mercury/import.h"
#include "mercury/random_voxel.h"
#include "mercury/robot_file.h"
#include "mercury/voxel.h"
#include "robots/importers/encodings.h"
#include "tests/fuzz/target.h"
#include "tests/robots/importers/documents.h"

namespace mercury::fuzz {
namespace {

void check(const Import& import) {
  require(import.robots.size() == import.report.robots.size(), "the report names other robots");
  for (const Robot& robot : import.robots) {
    validate(robot);
    require(parse_robot(serialize_robot(robot, RobotFormat::cbor), RobotFormat::cbor) == robot,
            "the robot does not read back as it was written");
  }
  for (const ImportedElement& element : import.report.elements) {
    require(!element.place.empty(), "an element without a place");
    require(!element.reason.empty(), "an element without a reason: " + element.place);
  }
  if (import.motion) {
    std::size_t masses = 0;
    for (const Robot& robot : import.robots) masses += robot.masses.size();
    require(import.motion->times.size() == import.motion->positions.size(), "frames without a time");
    for (const std::vector<Vec3>& frame : import.motion->positions) {
      require(frame.size() == masses, "a frame of other masses");
      for (const auto [x, y, z] : frame)
        require(std::isfinite(x) && std::isfinite(y) && std::isfinite(z), "a position that is not finite");
    }
  }
  require(!to_toml(import.settings, import.report).empty(), "no configuration");
}

std::string xml(const std::string& layers, const std::string& compression) {
  return "<VXA Version=\"1.0\"><Simulator><Damping><SlowDampingZ>0.01</SlowDampingZ></Damping></Simulator><Environment>"
         "<Gravity><GravEnabled>1</GravEnabled><GravAcc>-9.81</GravAcc><FloorEnabled>1</FloorEnabled></"
         "Gravity><Thermal>"
         "<TempEnabled>1</TempEnabled><TempAmp>39</TempAmp><TempBase>25</TempBase><VaryTempEnabled>1</VaryTempEnabled>"
         "<TempPeriod>0.5</TempPeriod></Thermal></Environment><VXC Version=\"0.93\"><Lattice><Lattice_Dim>0.05"
         "</Lattice_Dim></Lattice><Palette><Material ID=\"1\"><Name>Muscle</Name><Mechanical><Elastic_Mod>1e5"
         "</Elastic_Mod><Density>1000</Density><CTE>0.01</CTE><uDynamic>0.5</uDynamic></Mechanical></Material></"
         "Palette>"
         "<Structure Compression=\"" +
         compression + "\"><X_Voxels>2</X_Voxels><Y_Voxels>1</Y_Voxels><Z_Voxels>2</Z_Voxels><Data>" + layers +
         "</Data><PhaseOffset><Layer>0.1,0.2</Layer><Layer>0.3,0.4</Layer></PhaseOffset></Structure></VXC></VXA>";
}

std::string small_vxa() { return xml("<Layer>11</Layer><Layer>01</Layer>", "ASCII_READABLE"); }

const std::string rise =
    "<RSC><Simulator><Gravity><GravAcc>-9.81</GravAcc><FloorEnabled>1</FloorEnabled></Gravity></Simulator><Voxel>"
    "<Size>0.01</Size><Palette><Material ID=\"1\"><Mechanical><ElasticMod>3e4</ElasticMod><Density>800</Density>"
    "<MaxExpansion>0.5</MaxExpansion><MinExpansion>-0.5</MinExpansion></Mechanical></Material></Palette></Voxel>"
    "<Structure><Bodies><Body ID=\"1\"><X_Voxels>2</X_Voxels><Y_Voxels>1</Y_Voxels><Z_Voxels>1</Z_Voxels><MaterialID>"
    "<Layer>1,1</Layer></MaterialID><SegmentType><Layer>0,1</Layer></SegmentType><ExpansionSignalID><Layer>0,1</Layer>"
    "</ExpansionSignalID></Body></Bodies></Structure></RSC>";

}  // namespace

void check_vxa(std::string_view input) {
  const Import import = import_text(input, "vxa", "fuzz");
  check(import);
  if (import.robots.empty()) return;  // a base of VXD files
  // What is written of it can be read, and has the same body.
  const Robot& robot = import.robots.front();
  const Import back = import_text(vxa_document(robot), "vxa", "fuzz");
  require(back.robots.size() == 1 && back.robots.front().masses == robot.masses, "the VXA does not read back");
}

void check_vxd(std::string_view input) { check(import_text(input, "vxd", "fuzz", {}, small_vxa())); }
void check_rsc(std::string_view input) { check(import_text(input, "rsc", "fuzz")); }
void check_evogym(std::string_view input) { check(import_text(input, "evogym", "fuzz", {.depth = 2})); }
void check_npz(std::string_view input) { check(import_text(input, "npz", "fuzz")); }
void check_history(std::string_view input) { check(import_text(input, "history", "fuzz")); }

std::vector<std::string> vxa_seeds() {
  return {small_vxa(), xml("<Layer>AQE=</Layer><Layer>AAE=</Layer>", "BASE64"),
          xml("<Layer>eJxjZAQAAAUAAw==</Layer><Layer>eJxjYAQAAAMAAg==</Layer>", "ZLIB"),
          vxa_document(random_voxel_robot({.smallest = {2, 2, 2}, .largest = {2, 2, 2}}, 1))};
}

std::vector<std::string> vxd_seeds() {
  return {
      "<VXD/>",
      "<VXD><Structure replace=\"VXA.VXC.Structure\" Compression=\"ASCII_READABLE\"><X_Voxels>2</X_Voxels><Y_Voxels>1"
      "</Y_Voxels><Z_Voxels>1</Z_Voxels><Data><Layer>11</Layer></Data></Structure></VXD>"};
}

std::vector<std::string> rsc_seeds() { return {rise}; }

std::vector<std::string> evogym_seeds() {
  return {R"({"grid_width": 4, "grid_height": 3, "objects": {"robot": {"indices": [4, 5, 6, 8], "types": [3, 2, 4, 1],
"neighbors": {"4": [5, 8], "5": [4, 6], "6": [5], "8": [4]}}, "ground": {"indices": [0, 1, 2, 3], "types": [5, 5, 5, 5],
"neighbors": {}}, "box": {"indices": [7], "types": [2], "neighbors": {"7": []}}}})"};
}

std::vector<std::string> npz_seeds() { return {base64_decoded(stored_body), base64_decoded(compressed_body)}; }

std::vector<std::string> history_seeds() {
  const std::string settings = "{{{setting}}}<rescale>0.001</rescale>\n{{{setting}}}<voxel_size>0.01</voxel_size>\n";
  const std::string apart = "0,0,0,0,0,0,0,-5,-5,-5,5,5,5,1,0,;50,0,20,0,0,0,0,-5,-5,-5,5,5,5,3,0,;<<<>>>\n";
  return {settings + "<<<Step0 Time:0.001>>>" + apart,
          settings +
              "<<<Step0 Time:0.001>>>0,0,0,0,0,0,0,-5,-5,-5,5,5,5,1,0,;10,0,0,0,0,0,0,-5,-5,-5,5,5,5,1,0,;<<<>>>\n"
              "<<<Step42 Time:0.011>>>1,0,0,90,0,0,1,-6,-5,-5,6,5,5,1,0,;10,0,0,0,0,0,0,-5,-5,-5,5,5,5,1,0,;<<<>>>\n"};
}

}  // namespace mercury::fuzz
