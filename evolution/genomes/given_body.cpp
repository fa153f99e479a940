// SPDX-License-Identifier: Apache-2.0
#include "evolution/genomes/spaces.h"

#include <algorithm>

#include "mercury/error.h"
#include "mercury/muscle_laws.h"
#include "mercury/origin.h"
#include "mercury/random.h"
#include "robots/genes.h"

namespace mercury {
namespace {

constexpr std::uint8_t tag = 5;

struct GivenBody {
  Robot robot;
  std::vector<Material> materials;  // base materials
  std::vector<bool> in_use;
};
// What all genomes of a space share.
struct GivenBodies {
  std::vector<GivenBody> bodies;
  MuscleMutation muscles;
};
using Bodies = std::shared_ptr<const GivenBodies>;

class GivenBodyGenome : public Genome {
 public:
  GivenBodyGenome(Bodies bodies, std::size_t body, MuscleStep step, MaterialGenes materials)
      : bodies_(std::move(bodies)), body_(body), step_(step), materials_(std::move(materials)) {}

  Robot grow(const std::string& name) const override {
    Robot robot = with_base_materials(body().robot, materials_);
    robot.name = name;
    return robot;
  }
  GenomePointer mutate(double strength, std::uint64_t seed) const override {
    if (strength == 0) return make(step_, materials_);
    const auto [mutation, step] =
        step_.child(bodies_->muscles, muscle_numbers_of(materials_, body().in_use), strength, seed);
    return make(step, mutated(materials_, mutation, seed, body().in_use));
  }
  GenomePointer cross(const Genome& other, std::uint64_t seed) const override {
    const auto* mate = dynamic_cast<const GivenBodyGenome*>(&other);
    if (!mate) throw InputError("crossover", "two genomes of one space are needed");
    return make(step_.crossed(mate->step_), crossed(materials_, mate->materials_, seed));
  }
  std::uint64_t identity() const override {
    IdentityHash hash;
    hash.add(static_cast<std::uint32_t>(body_));
    add_identity(hash, materials_, body().in_use);
    return hash.value();
  }
  std::string encode() const override {
    ByteWriter writer;
    write_head(writer, tag);
    step_.write(writer, bodies_->muscles);
    writer.add(static_cast<std::uint32_t>(body_));
    write(writer, materials_);
    return std::move(writer).take();
  }
  std::vector<double> numbers() const override { return muscle_numbers(body().materials, body().in_use, materials_); }
  GenomePointer with_numbers(std::span<const double> numbers) const override {
    return make(step_, with_muscle_numbers(body().materials, body().in_use, numbers));
  }

 private:
  const GivenBody& body() const { return bodies_->bodies[body_]; }
  GenomePointer make(MuscleStep step, MaterialGenes materials) const {
    return std::make_shared<GivenBodyGenome>(bodies_, body_, step, std::move(materials));
  }

  Bodies bodies_;
  std::size_t body_;
  MuscleStep step_;
  MaterialGenes materials_;
};

class GivenBodySpace : public GenomeSpace {
 public:
  explicit GivenBodySpace(const GenomeSpaceRequest& request) {
    auto bodies = std::make_shared<GivenBodies>();
    bodies->muscles = request.muscles;
    for (const Robot& founder : request.founders) {
      validate(founder);
      GivenBody body{founder, base_materials_of(founder), base_materials_in_use(founder)};
      for (std::size_t i = 0; i < body.materials.size(); ++i)
        if (body.materials[i].amplitude == 0) body.in_use[i] = false;  // passive materials do not change
      if (contains(request.genes, Genes::muscles) && std::ranges::find(body.in_use, true) == body.in_use.end())
        throw InputError("robot " + founder.name, "has no muscles that could change");
      if (!request.environment.empty()) add_environment(body.robot, request.environment);
      bodies->bodies.push_back(std::move(body));
    }
    bodies_ = std::move(bodies);
  }

  GenomePointer random(std::uint64_t seed, std::uint64_t index) const override {
    const std::size_t body = index % founders();
    const auto founder =
        std::make_shared<GivenBodyGenome>(bodies_, body, MuscleStep(), bodies_->bodies[body].materials);
    if (index < founders()) return founder;
    Random random(seed_of(seed, index));
    const double strength = random.uniform(1, 8);
    return founder->mutate(strength, random.bits());
  }
  std::size_t founders() const override { return bodies_->bodies.size(); }
  GenomePointer decode(std::string_view bytes) const override try {
    ByteReader reader(bytes);
    read_head(reader, tag);
    const MuscleStep step = MuscleStep::read(reader, bodies_->muscles);
    const auto body = reader.read<std::uint32_t>();
    if (body >= founders())
      throw InputError("genome", "is of body " + std::to_string(body) + " of " + std::to_string(founders()));
    MaterialGenes materials = read_material_genes(reader);
    reader.end();
    const std::size_t expected = bodies_->bodies[body].materials.size();
    if (materials.size() != expected)
      throw InputError("genome",
                       "has " + std::to_string(materials.size()) + " materials, its body " + std::to_string(expected));
    return std::make_shared<GivenBodyGenome>(bodies_, body, step, std::move(materials));
  } catch (const DamagedBytes& error) {
    throw InputError("genome", error.what());
  }

 private:
  // An origin that names another environment keeps it.
  static void add_environment(Robot& robot, const std::string& environment) {
    if (!environment_of(robot).empty() || !robot.origin.starts_with('{')) return;
    const bool is_empty = robot.origin.find_first_not_of(" \t\r\n", 1) == robot.origin.rfind('}');
    robot.origin.insert(1, "\"environment\":\"" + environment + (is_empty ? "\"" : "\","));
  }

  Bodies bodies_;
};

}  // namespace

std::unique_ptr<GenomeSpace> make_given_body_space(const GenomeSpaceRequest& request) {
  return std::make_unique<GivenBodySpace>(request);
}

}  // namespace mercury
