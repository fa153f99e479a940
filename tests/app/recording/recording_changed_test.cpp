// SPDX-License-Identifier: Apache-2.0
// A recording with one change gives valid robots or an InputError of one line. The reader allocates no memory for what
// the file does not have.
#include <sys/resource.h>

#include <array>
#include <functional>

#include "app/recording/trajectory_hdf5_reading.h"
#include "app/recording/trajectory_hdf5_writing.h"
#include "app/recording/trajectory_reader.h"
#include "mercury/error.h"
#include "tests/app/program.h"
#include "tests/app/recording/recording_bodies.h"
#include "tests/refusal.h"

#ifdef __SANITIZE_ADDRESS__
constexpr bool sanitized = true;
// HDF5 itself loses memory over damaged files.
extern "C" const char* __lsan_default_suppressions();
extern "C" const char* __lsan_default_suppressions() { return "leak:libhdf5"; }
#else
constexpr bool sanitized = false;
#endif

namespace mercury::test {
namespace {

using hdf5::checked;
using hdf5::Handle;

// All objects of a file by their paths, and the attributes of each.
struct Contents {
  std::vector<std::string> groups, datasets;
  std::vector<std::pair<std::string, std::string>> attributes;
};

Contents contents_of(const std::string& path) {
  Contents contents;
  const std::function<void(hid_t, const std::string&)> visit = [&](hid_t group, const std::string& name) {
    for (const std::string& member : hdf5::members(group)) {
      const std::string below = name + "/" + member;
      const Handle object(H5Oopen(group, member.c_str(), H5P_DEFAULT));
      const auto count = static_cast<unsigned>(checked(H5Aget_num_attrs(object)));
      for (unsigned i = 0; i < count; ++i) {
        const Handle attribute(H5Aopen_by_idx(object, ".", H5_INDEX_NAME, H5_ITER_INC, i, H5P_DEFAULT, H5P_DEFAULT));
        std::string text(256, '\0');
        text.resize(static_cast<std::size_t>(checked(H5Aget_name(attribute, text.size(), text.data()))));
        contents.attributes.emplace_back(below, text);
      }
      if (H5Iget_type(object) == H5I_GROUP) {
        contents.groups.push_back(below);
        visit(object, below);
      } else {
        contents.datasets.push_back(below);
      }
    }
  };
  hdf5::prepare();
  const Handle file(H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT));
  visit(file, "");
  return contents;
}

class RecordingChanged : public FolderTest {
 protected:
  RecordingChanged() {
    keep_freed_memory();
    Robot robot = small_voxel_robot(0);
    Simulation simulation(on_cpu(),
                          std::vector{robot, own_materials("own"), own_points("points"), thinking_pair("thinker")});
    record(simulation, path("sound.h5"), 8, 1, {.seed = 3, .brains = true});
    contents_ = contents_of(path("sound.h5"));
  }

  // Reads everything. Returns the message of the error; empty = none.
  std::string refusal(const std::string& name) const {
    const std::string message = mercury::refusal([&] {
      TrajectoryReader reader(path(name));
      for (const RecordedRobot& recorded : reader.robots()) validate(recorded.robot);
      validate(reader.configuration());
      for (std::size_t frame = 0; frame < reader.frames(); ++frame) {
        reader.positions(frame);
        reader.velocities(frame);
        reader.senses(frame);
        reader.neurons(frame);
        reader.state(frame);
      }
    });
    EXPECT_EQ(message.find('\n'), std::string::npos) << message;
    return message;
  }

  void expect_modest_memory() const {
    if (sanitized) return;  // keeps what was freed
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    EXPECT_LT(usage.ru_maxrss, 600 * 1024) << "kB";
  }

  // The undamaged file with one change.
  template <class Change>
  std::string refusal_after(const Change& change) {
    std::filesystem::remove(path("changed.h5"));
    std::filesystem::copy_file(path("sound.h5"), path("changed.h5"));
    {
      const Handle file(H5Fopen(path("changed.h5").c_str(), H5F_ACC_RDWR, H5P_DEFAULT));
      change(file);
    }
    return refusal("changed.h5");
  }

  Contents contents_;
};

void remove(hid_t file, const std::string& object) { checked(H5Ldelete(file, object.c_str(), H5P_DEFAULT)); }

void put_dataset(hid_t file, const std::string& name, hid_t type, const hdf5::Extent& extent) {
  remove(file, name);
  const Handle space(H5Screate_simple(static_cast<int>(extent.size()), extent.data(), nullptr));
  const Handle dataset(H5Dcreate2(file, name.c_str(), type, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT));
}

// A dataset of any extent whose chunks are not stored.
void put_announced(hid_t file, const std::string& name, hid_t type, const hdf5::Extent& extent) {
  remove(file, name);
  const Handle space(H5Screate_simple(static_cast<int>(extent.size()), extent.data(), nullptr));
  const Handle properties(H5Pcreate(H5P_DATASET_CREATE));
  checked(H5Pset_chunk(properties, static_cast<int>(extent.size()), hdf5::Extent(extent.size(), 1).data()));
  const Handle dataset(H5Dcreate2(file, name.c_str(), type, space, H5P_DEFAULT, properties, H5P_DEFAULT));
}

// Whether the reader needs the dataset. The rest is for other programs: the tables under /connectivity, and the time
// axis of each element, which is a link, and the names of senses and neurons.
bool is_read(const std::string& name) {
  const std::string last = name.substr(name.rfind('/') + 1);
  if (last == "step" || last == "time") return name.starts_with("/parameters/");
  return name.starts_with("/particles/") || (name.starts_with("/observables/") && last == "value");
}

TEST_F(RecordingChanged, AParameterThatAnOlderProgramDidNotRecordHasItsDefault) {
  EXPECT_EQ(refusal_after(
                [](hid_t file) { checked(H5Adelete_by_name(file, "/parameters", "drag_tangential", H5P_DEFAULT)); }),
            "");
  EXPECT_EQ(TrajectoryReader(path("changed.h5")).configuration().environment, Environment(Ocean{}));
}

TEST_F(RecordingChanged, ARecordingOfLandByAnOlderProgramHasTheContactsOfThen) {
  Configuration on_land = on_cpu();
  on_land.environment = Land{};
  Simulation simulation(on_land, std::vector{pair("pair")});
  std::filesystem::remove(path("sound.h5"));
  record(simulation, path("sound.h5"), 1, 1);
  EXPECT_EQ(refusal_after([](hid_t file) {
              for (const char* name : {"relative_stiffness", "contact_distance"})
                checked(H5Adelete_by_name(file, "/parameters", name, H5P_DEFAULT));
            }),
            "");
  EXPECT_EQ(TrajectoryReader(path("changed.h5")).configuration().environment, Environment(Land{}));
}

TEST_F(RecordingChanged, ARecordingThatSaysNothingOfItsMassesHasOnesOf1kgAtRest) {
  EXPECT_EQ(refusal_after([](hid_t file) {
              for (const char* name : {"mass", "start_velocity", "fixed"})
                remove(file, std::string("/particles/points/") + name);
            }),
            "");
  const TrajectoryReader reader(path("changed.h5"));
  const Robot& robot = reader.robots()[2].robot;
  EXPECT_EQ(robot.masses.size(), 3u);
  EXPECT_TRUE(robot.mass.empty() && robot.velocity.empty() && robot.fixed.empty());
}

TEST_F(RecordingChanged, MassesThatBreakARuleAreNamedWithTheRule) {
  const auto with = [&](const char* name, hid_t type, const auto& values) {
    return refusal_after([&](hid_t file) {
      const Handle dataset(H5Dopen2(file, (std::string("/particles/points/") + name).c_str(), H5P_DEFAULT));
      checked(H5Dwrite(dataset, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()));
    });
  };
  const std::string place = path("changed.h5") + ": /particles/points: ";
  EXPECT_EQ(with("mass", H5T_NATIVE_FLOAT, std::array{1.f, 2.f, 3.f}), "");
  EXPECT_EQ(with("mass", H5T_NATIVE_FLOAT, std::array{1.f, 0.f, 3.f}),
            place + "/mass/1: a mass must be a finite number above 0 kg");
  EXPECT_EQ(with("fixed", H5T_NATIVE_UINT16, std::array<std::uint16_t, 2>{1, 9}),
            place + "/fixed/1: mass 9 is out of range, the robot has 3");
}

TEST_F(RecordingChanged, EveryMissingPartIsReportedOrNotNeeded) {
  int refused = 0;
  for (const auto* objects : {&contents_.groups, &contents_.datasets})
    for (const std::string& object : *objects) {
      SCOPED_TRACE(object);
      refused += !refusal_after([&](hid_t file) { remove(file, object); }).empty();
    }
  for (const auto& [object, name] : contents_.attributes) {
    SCOPED_TRACE(object + " " + name);
    refused += !refusal_after([&, &object = object, &name = name](hid_t file) {
                  checked(H5Adelete_by_name(file, object.c_str(), name.c_str(), H5P_DEFAULT));
                }).empty();
  }
  EXPECT_GT(refused, 40);
}

TEST_F(RecordingChanged, DatasetsOfOtherShapesAndTypesAreReportedOrUsable) {
  const Handle text(H5Tcopy(H5T_C_S1));
  checked(H5Tset_size(text, H5T_VARIABLE));
  for (const std::string& name : contents_.datasets) {
    SCOPED_TRACE(name);
    for (const hdf5::Extent& extent : {hdf5::Extent{}, {0}, {3}, {2, 2}, {9, 3}, {2, 2, 2, 2}})
      for (const hid_t type : {H5T_NATIVE_DOUBLE, H5T_STD_I8BE, hid_t{text}})
        refusal_after([&](hid_t file) { put_dataset(file, name, type, extent); });
  }
  expect_modest_memory();
}

TEST_F(RecordingChanged, AnnouncedExtentsAllocateNoMemory) {
  constexpr hsize_t huge = hsize_t{1} << 40;
  for (const std::string& name : contents_.datasets) {
    SCOPED_TRACE(name);
    for (const hdf5::Extent& extent : {hdf5::Extent{huge}, {huge, 2}, {huge, 3}, {9, huge, 3}, {huge, 2, 3}}) {
      const std::string refused =
          refusal_after([&](hid_t file) { put_announced(file, name, H5T_NATIVE_FLOAT, extent); });
      EXPECT_EQ(!refused.empty(), is_read(name)) << refused;
    }
  }
  expect_modest_memory();
}

TEST_F(RecordingChanged, AttributesOfOtherKindsAreReportedOrUsable) {
  for (const auto& [object, name] : contents_.attributes) {
    SCOPED_TRACE(object + " " + name);
    const auto put = [&, &object = object, &name = name](hid_t type, const hdf5::Extent& extent, const void* content) {
      return refusal_after([&](hid_t file) {
        const Handle owner(H5Oopen(file, object.c_str(), H5P_DEFAULT));
        checked(H5Adelete(owner, name.c_str()));
        const Handle space(H5Screate_simple(static_cast<int>(extent.size()), extent.data(), nullptr));
        const Handle attribute(H5Acreate2(owner, name.c_str(), type, space, H5P_DEFAULT, H5P_DEFAULT));
        checked(H5Awrite(attribute, type, content));
      });
    };
    const double numbers[] = {std::numeric_limits<double>::quiet_NaN(), -1e300, 7};
    put(H5T_NATIVE_DOUBLE, {}, numbers);
    put(H5T_NATIVE_DOUBLE, {1}, numbers + 1);
    put(H5T_NATIVE_DOUBLE, {3}, numbers);
    const Handle text(H5Tcopy(H5T_C_S1));
    put(text, {}, "x");
    checked(H5Tset_size(text, H5T_VARIABLE));
    const char* word = "neither this nor that";
    put(text, {}, &word);
  }
}

TEST_F(RecordingChanged, TextsOfVariableLengthAsPythonWritesThemAreRead) {
  EXPECT_EQ(refusal_after([&](hid_t file) {
              const Handle parameters = hdf5::open_group(file, "parameters");
              checked(H5Adelete(parameters, "solver"));
              hdf5::write_unit(parameters, "xpbd", "solver");
            }),
            "");
  EXPECT_EQ(TrajectoryReader(path("changed.h5")).configuration().solver, Solver::xpbd);
}

TEST_F(RecordingChanged, ARobotThatBreaksARuleIsNamedWithTheRule) {
  const std::string refused = refusal_after([&](hid_t file) {
    const Handle dataset(H5Dopen2(file, "/particles/own/springs", H5P_DEFAULT));
    const std::uint16_t ends[] = {0, 912};
    checked(H5Dwrite(dataset, H5T_NATIVE_UINT16, H5S_ALL, H5S_ALL, H5P_DEFAULT, ends));
  });
  EXPECT_EQ(refused, path("changed.h5") + ": /particles/own: /springs/0: mass 912 is out of range, the robot has 2");
}

TEST_F(RecordingChanged, ActuatorsThatBreakARuleAreNamedWithTheRule) {
  const auto with = [&](std::array<std::uint8_t, 4> pairs) {
    return refusal_after([&](hid_t file) {
      const Handle dataset(H5Dopen2(file, "/particles/own/actuator_materials", H5P_DEFAULT));
      checked(H5Dwrite(dataset, H5T_NATIVE_UINT8, H5S_ALL, H5S_ALL, H5P_DEFAULT, pairs.data()));
    });
  };
  const std::string place = path("changed.h5") + ": /particles/own: ";
  EXPECT_EQ(with({0, 1, 0, 2}), "");
  EXPECT_EQ(with({0, 1, 3, 2}), place + "\"actuator_materials\" names actuator 3 of 1");
  EXPECT_EQ(with({0, 1, 0, 7}), place + "/actuators/0: material 7 is out of range, the table has 3");
}

// As other programs may write the table: half_wave as a number, of any size.
TEST_F(RecordingChanged, HalfWavesMayBeNumbers) {
  const auto with = [&](hid_t type, const void* rows) {
    return refusal_after([&](hid_t file) {
      put_dataset(file, "/particles/own/materials", type, {3});
      const Handle dataset(H5Dopen2(file, "/particles/own/materials", H5P_DEFAULT));
      checked(H5Dwrite(dataset, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, rows));
    });
  };
  struct Row {
    float stiffness, amplitude, frequency, phase;
    std::int32_t half_wave;
  };
  const Row rows[] = {{0, 0, 0, 0, 0}, {30, 0.2f, 3, 0.5f, 1}, {70, 0, 0, 0, 200}};
  const Handle type(H5Tcreate(H5T_COMPOUND, sizeof(Row)));
  int offset = 0;
  for (const char* name : {"stiffness", "amplitude", "frequency", "phase"}) {
    checked(H5Tinsert(type, name, static_cast<std::size_t>(offset), H5T_NATIVE_FLOAT));
    offset += 4;
  }
  const Handle without(H5Tcopy(type));
  checked(H5Tinsert(type, "half_wave", offsetof(Row, half_wave), H5T_NATIVE_INT32));
  const auto half_waves = [&] {
    const TrajectoryReader reader(path("changed.h5"));
    std::vector<bool> found;
    for (const RecordedRobot& recorded : reader.robots())
      if (recorded.robot.name == "own")
        for (const Material& material : recorded.robot.materials) found.push_back(material.half_wave);
    return found;
  };
  EXPECT_EQ(with(type, rows), "");
  EXPECT_EQ(half_waves(), (std::vector<bool>{false, true, true}));
  EXPECT_EQ(with(without, rows), "") << "as older programs wrote it";
  EXPECT_EQ(half_waves(), (std::vector<bool>{false, false, false}));
  const Handle text(H5Tcopy(H5T_C_S1)), wrong(H5Tcopy(without));
  checked(H5Tinsert(wrong, "half_wave", offsetof(Row, half_wave), text));
  EXPECT_NE(with(wrong, rows), "");
}

TEST_F(RecordingChanged, SensesAndNeuronsOfOtherNumbersAreNamed) {
  const std::string place = path("changed.h5") + ": /observables/thinker: ";
  EXPECT_EQ(refusal_after([](hid_t file) {
              put_dataset(file, "/observables/thinker/senses/value", H5T_NATIVE_FLOAT, {9, 5});
            }),
            place + "senses/value has another shape than its robot and the file's frames");
  EXPECT_EQ(refusal_after([](hid_t file) { remove(file, "/observables/thinker/neurons"); }),
            place + "the group \"neurons\" is missing");
  EXPECT_EQ(refusal_after([](hid_t file) { remove(file, "/observables/thinker/senses/name"); }), "");
}

TEST_F(RecordingChanged, ARecordingOfAnOlderProgramHasNoSensesAndNeurons) {
  EXPECT_EQ(refusal_after([](hid_t file) { remove(file, "/observables"); }), "");
  EXPECT_FALSE(TrajectoryReader(path("changed.h5")).has_brains());
}

TEST_F(RecordingChanged, ARecordingOfAnOlderProgramHasNoActuators) {
  EXPECT_EQ(refusal_after([](hid_t file) {
              remove(file, "/particles/own/actuators");
              remove(file, "/particles/own/actuator_materials");
            }),
            "");
}

}  // namespace
}  // namespace mercury::test
