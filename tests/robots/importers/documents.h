// SPDX-License-Identifier: Apache-2.0
// Small files of other simulators, written for the tests.
#pragma once

#include <algorithm>
#include <string>

#include "mercury/import.h"
#include "tests/refusal.h"

namespace mercury {

// A body of EvoGym as numpy.savez writes it (NumPy 1.26.4), in base64; the same compressed.
inline const std::string stored_body =
    "UEsDBBQAAAAAAAAAIQD9KqnUsAAAALAAAAAJABQAYXJyXzAubnB5AQAQALAAAAAAAAAAsAAAAAAAAACTTlVNUFkBAHYAeydkZXNjcic6ICc8Zjgn"
    "LCAnZm9ydHJhbl9vcmRlcic6IEZhbHNlLCAnc2hhcGUnOiAoMiwgMyksIH0gICAgICAgICAgICAgICAgICAgICAgICAgICAgICAgICAgICAgICAg"
    "ICAgICAgICAgICAgICAgICAgCgAAAAAAAPA/AAAAAAAAAAAAAAAAAAAIQAAAAAAAAAhAAAAAAAAAAEAAAAAAAAAQQFBLAwQUAAAAAAAAACEAu9ry"
    "ocAAAADAAAAACQAUAGFycl8xLm5weQEAEADAAAAAAAAAAMAAAAAAAAAAk05VTVBZAQB2AHsnZGVzY3InOiAnPGk4JywgJ2ZvcnRyYW5fb3JkZXIn"
    "OiBUcnVlLCAnc2hhcGUnOiAoMiwgNCksIH0gICAgICAgICAgICAgICAgICAgICAgICAgICAgICAgICAgICAgICAgICAgICAgICAgICAgICAgICAg"
    "IAoAAAAAAAAAAAMAAAAAAAAAAgAAAAAAAAAFAAAAAAAAAAMAAAAAAAAABAAAAAAAAAAEAAAAAAAAAAUAAAAAAAAAUEsBAhQDFAAAAAAAAAAhAP0q"
    "qdSwAAAAsAAAAAkAAAAAAAAAAAAAAIABAAAAAGFycl8wLm5weVBLAQIUAxQAAAAAAAAAIQC72vKhwAAAAMAAAAAJAAAAAAAAAAAAAACAAesAAABh"
    "cnJfMS5ucHlQSwUGAAAAAAIAAgBuAAAA5gEAAAAA";
inline const std::string compressed_body =
    "UEsDBBQAAAAIAAAAIQD9KqnUVgAAALAAAAAJABQAYXJyXzAubnB5AQAQALAAAAAAAAAAVgAAAAAAAACb7BfqGxDJyFDGUK2eklqcXKRupaBuk2ah"
    "rqOgnpZfVFKUmBefX5SSChJ3S8wpTgWKF2ckFqQC+RpGOgrGmjoKtQpkAy4GMPhgz4ACOBxQaQYoLeAAAFBLAwQUAAAACAAAACEAu9ryoVUAAADA"
    "AAAACQAUAGFycl8xLm5weQEAEADAAAAAAAAAAFUAAAAAAAAAm+wX6hsQychQxlCtnpJanFykbqWgbpNpoa6joJ6WX1RSlJgXn1+UkgoSDykqTQUK"
    "F2ckFqQCuRpGOgommjoKtQrkAy4GKGCG0kxQmhVNnAWNhskDAFBLAQIUAxQAAAAIAAAAIQD9KqnUVgAAALAAAAAJAAAAAAAAAAAAAACAAQAAAABh"
    "cnJfMC5ucHlQSwECFAMUAAAACAAAACEAu9ryoVUAAADAAAAACQAAAAAAAAAAAAAAgAGRAAAAYXJyXzEubnB5UEsFBgAAAAACAAIAbgAAACEBAAAA"
    "AA==";

// A VXA of 2 x 1 x 2 voxels whose parts can be replaced: muscle, tissue; empty, opposite muscle.
struct VxaParts {
  std::string simulator = "<Damping><SlowDampingZ>0.01</SlowDampingZ></Damping>";
  std::string gravity = "<GravEnabled>1</GravEnabled><GravAcc>-9.81</GravAcc><FloorEnabled>1</FloorEnabled>";
  std::string thermal =
      "<TempEnabled>1</TempEnabled><TempAmp>39</TempAmp><TempBase>25</TempBase>"
      "<VaryTempEnabled>1</VaryTempEnabled><TempPeriod>0.5</TempPeriod>";
  std::string environment;
  std::string lattice = "<Lattice_Dim>0.025</Lattice_Dim>";
  std::string materials = material("Muscle", 1e5, 0.01) + material("Tissue", 2e5, 0) + material("Opposite", 1e5, -0.01);
  std::string compression = "ASCII_READABLE";
  std::string size = "<X_Voxels>2</X_Voxels><Y_Voxels>1</Y_Voxels><Z_Voxels>2</Z_Voxels>";
  std::string data = "<Layer><![CDATA[12]]></Layer><Layer><![CDATA[03]]></Layer>";
  std::string layers;  // after Data

  static std::string material(const std::string& name, double modulus, double expansion) {
    return "<Material ID=\"9\"><Name>" + name + "</Name><Mechanical><Elastic_Mod>" + std::to_string(modulus) +
           "</Elastic_Mod><Density>1000</Density><CTE>" + std::to_string(expansion) +
           "</CTE><uStatic>1</uStatic><uDynamic>0.5</uDynamic></Mechanical></Material>";
  }

  std::string text() const {
    return "<?xml version=\"1.0\"?><VXA Version=\"1.0\"><Simulator>" + simulator + "</Simulator><Environment>" +
           environment + "<Gravity>" + gravity + "</Gravity><Thermal>" + thermal +
           "</Thermal></Environment><VXC Version=\"0.93\"><Lattice>" + lattice + "</Lattice><Palette>" + materials +
           "</Palette><Structure Compression=\"" + compression + "\">" + size + "<Data>" + data + "</Data>" + layers +
           "</Structure></VXC></VXA>";
  }
};

// "0,0.25,0.5,0.75,": a turn in equal steps.
inline std::string phases_along_x(int voxels) {
  std::string phases;
  for (int x = 0; x < voxels; ++x) {
    phases += std::to_string(static_cast<double>(x) / voxels);
    phases += ',';
  }
  return phases;
}

inline Import import_of(const VxaParts& parts, const ImportOptions& options = {}) {
  return import_text(parts.text(), "vxa", "test", options);
}

inline std::string refusal_of(std::string_view text, std::string_view format, std::string_view base = {}) {
  return refusal([&] { import_text(text, format, "test", {}, base); });
}

inline const ImportedElement* element_at(const ImportReport& report, std::string_view place) {
  const auto found = std::ranges::find(report.elements, place, &ImportedElement::place);
  return found == report.elements.end() ? nullptr : &*found;
}

}  // namespace mercury
