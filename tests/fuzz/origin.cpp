// SPDX-License-Identifier: Apache-2.0
// Origins of robots: growing again, mutation, crossover, evolution and the export of voxels read there how a robot was
// made.
#include "mercury/origin.h"

#include <exception>

#include "mercury/error.h"
#include "mercury/generator.h"
#include "mercury/import.h"
#include "mercury/random_voxel.h"
#include "mercury/real_body.h"
#include "mercury/robot_file.h"
#include "robots/genes.h"
#include "robots/importers/voxel_body.h"
#include "tests/fuzz/target.h"

namespace mercury::fuzz {
namespace {

constexpr RobotFormat format = RobotFormat::json;

// The first of several refusals; the readers after it are tried, too.
class Refusal {
 public:
  template <class Read>
  void of(const Read& read) {
    try {
      read();
    } catch (const InputError&) {
      if (!first_) first_ = std::current_exception();
    }
  }
  void rethrow() const {
    if (first_) std::rethrow_exception(first_);
  }

 private:
  std::exception_ptr first_;
};

void check_grown(const Generator& generator, const Robot& robot) {
  validate(robot);
  require(parse_robot(serialize_robot(robot, format), format) == robot,
          "the robot does not read back as it was written");
  require(generator.regrow(robot) == robot, "the robot does not grow again");
}

// As small as robots of a kind get.
ParameterValues small_values(const std::string& kind) {
  if (kind == "voxel") return {{"voxels", SizeRange{{2, 1, 1}, {2, 1, 1}}}, {"air", 0.0}};
  if (kind == "nn") return {{"points", std::int64_t{64}}, {"hidden", std::vector<int>{2}}};
  if (kind == "cppn") return {{"canvas", SizeRange{{2, 2, 2}, {2, 2, 2}}}};
  return {};
}

// A robot of two masses that says it was made as the given one: bodies are long, and most readers look at origin and
// materials alone.
std::string stub_of(const Robot& grown) {
  Robot robot;
  robot.name = "pair";
  robot.masses = {{0, 0, 0}, {0.1f, 0, 0}};
  robot.springs = {{0, 1, 1, 0.1f}};
  robot.materials = grown.materials;
  robot.material_names = grown.material_names;
  robot.origin = grown.origin;
  return serialize_robot(robot, format);
}

}  // namespace

void check_origin(std::string_view input) {
  const Robot robot = parse_robot(input, format);
  validate(robot);
  Refusal refusal;
  environment_of(robot);
  refusal.of([&] {
    if (const std::optional<Ancestry> ancestry = ancestry_of(robot)) {
      Robot again = robot;
      again.origin = with_ancestry(robot.origin, *ancestry);
      require(ancestry_of(again) == ancestry, "the ancestry does not read back as it was written");
    }
  });
  refusal.of([&] {
    if (real_material_of(robot)) validate(without_real_body(robot));
  });
  refusal.of([&] {
    const Robot paper = real_material_of(robot) ? without_real_body(robot) : robot;
    if (voxel_body_of(paper)) vxa_document(robot);
  });
  if (const Generator* generator = generator_of(robot)) {
    const MutationRequest mutation{.muscles = 1};
    refusal.of([&] { check_grown(*generator, generator->regrow(robot)); });
    refusal.of([&] { check_grown(*generator, generator->mutate(robot, mutation, "mutant")); });
    if (generator->cross) refusal.of([&] { check_grown(*generator, generator->cross(robot, robot, 1, "child")); });
    if (generator->genes)
      refusal.of([&] {
        const Robot paper = real_material_of(robot) ? without_real_body(robot) : robot;  // as evolution does
        validate(generator->genes->of(paper)->grown("grown", "ocean"));
      });
    if (generator->cells) refusal.of([&] { generator->cells(robot); });
  }
  refusal.rethrow();
}

std::vector<std::string> origin_seeds() {
  std::vector<std::string> seeds;
  for (const Generator& generator : generators()) {
    try {
      const Robot robot = generator.make(small_values(generator.kind), "", 1, 0);
      seeds.push_back(stub_of(robot));
      seeds.push_back(stub_of(generator.mutate(robot, {}, "mutant")));
    } catch (const InputError&) {
      continue;  // a build without networks
    }
  }
  const RandomVoxelOptions one{.smallest = {1, 1, 1}, .largest = {1, 1, 1}, .air = 0};
  seeds.push_back(serialize_robot(with_real_body(random_voxel_robot(one, 1), {}), format));
  const VoxelBody drawing{
      .nx = 2,
      .ny = 1,
      .nz = 1,
      .cells = {1, 2},
      .substances = {{.stiffness = 40}, {.stiffness = 50, .amplitude = 0.14, .frequency = 2, .size = 1.5}},
      .names = {"tissue", "muscle"}};
  Robot imported;
  imported.origin = import_origin(drawing, {.file = "a.vxa", .format = "vxa", .environment = "land"});
  seeds.push_back(stub_of(imported));
  return seeds;
}

}  // namespace mercury::fuzz
