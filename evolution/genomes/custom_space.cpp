// SPDX-License-Identifier: Apache-2.0
// Custom genomes (mercury/custom.h). A genome holds the text of the program and the whole robot, so that the robots of
// a run can be grown where the program is not.
#include <utility>

#include "evolution/genomes/spaces.h"
#include "mercury/custom.h"
#include "mercury/error.h"
#include "mercury/robot_file.h"
#include "robots/genes.h"

namespace mercury {

struct CustomSpace::Context {
  std::string name;
  CustomOperators operators;

  template <class Operator>
  const Operator& needed(const Operator& one) const {
    if (!one) throw InputError("genomes", name + " are made by a program, which has to be there to make others");
    return one;
  }
};

namespace {

constexpr std::uint8_t custom_tag = 90;

class CustomGenome : public Genome {
 public:
  CustomGenome(CustomGenes genes, std::shared_ptr<const CustomSpace::Context> context)
      : genes_(std::move(genes)), context_(std::move(context)) {}

  const CustomGenes& genes() const { return genes_; }

  Robot grow(const std::string& name) const override {
    if (!genes_.problem.empty()) throw InputError(genes_.problem);
    Robot robot = genes_.robot;
    robot.name = name;
    return robot;
  }
  GenomePointer mutate(double strength, std::uint64_t seed) const override {
    return make(context_->needed(context_->operators.mutate)(genes_, strength, seed));
  }
  GenomePointer cross(const Genome& other, std::uint64_t seed) const override {
    return make(context_->needed(context_->operators.cross)(genes_, custom_genes_of(other), seed));
  }
  std::uint64_t identity() const override {
    return identity_.value([&](IdentityHash& hash) { hash.add(genes_.problem.empty() ? document() : genes_.text); });
  }
  std::string encode() const override {
    ByteWriter writer;
    write_head(writer, custom_tag);
    writer.text(genes_.text);
    writer.text(genes_.problem);
    writer.text(document());
    return std::move(writer).take();
  }

 private:
  std::string document() const {
    return genes_.problem.empty() ? serialize_robot(genes_.robot, RobotFormat::cbor) : std::string();
  }
  GenomePointer make(CustomGenes genes) const { return std::make_shared<CustomGenome>(std::move(genes), context_); }

  const CustomGenes genes_;
  const std::shared_ptr<const CustomSpace::Context> context_;
  CachedIdentity identity_;
};

}  // namespace

CustomSpace::CustomSpace(std::string name, CustomOperators operators)
    : context_(std::make_shared<const Context>(Context{std::move(name), std::move(operators)})) {
  check_custom_name("kind", context_->name);
}

GenomePointer CustomSpace::random(std::uint64_t seed, std::uint64_t index) const {
  return genome(context_->needed(context_->operators.random)(seed, index));
}

GenomePointer CustomSpace::decode(std::string_view bytes) const try {
  ByteReader reader(bytes);
  read_head(reader, custom_tag);
  CustomGenes genes;
  genes.text = reader.text();
  genes.problem = reader.text();
  const std::string_view robot = reader.text();
  reader.end();
  if (genes.problem.empty()) genes.robot = parse_robot(robot, RobotFormat::cbor);
  return std::make_shared<CustomGenome>(std::move(genes), context_);
} catch (const DamagedBytes& error) {
  throw InputError("genome", error.what());
}

GenomePointer CustomSpace::genome(CustomGenes genes) const {
  genes.robot.name.clear();
  if (genes.problem.empty()) validate(genes.robot);
  return std::make_shared<CustomGenome>(std::move(genes), context_);
}

const CustomGenes& custom_genes_of(const Genome& genome) {
  const auto* custom = dynamic_cast<const CustomGenome*>(&genome);
  if (!custom) throw InputError("genome", "is not of a program");
  return custom->genes();
}

}  // namespace mercury
