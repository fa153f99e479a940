// SPDX-License-Identifier: Apache-2.0
// Run folders of evolutions: run.toml, the journal, encoded genomes.
#include <filesystem>
#include <fstream>

#include "evolution/run_folder/generation_record.h"
#include "evolution/run_folder/journal.h"
#include "evolution/run_folder/run_file.h"
#include "mercury/error.h"
#include "mercury/evolution.h"
#include "mercury/genome.h"
#include "mercury/quantity.h"
#include "mercury/random.h"
#include "mercury/run_folder.h"
#include "mercury/voxel.h"
#include "robots/bytes.h"
#include "tests/fuzz/target.h"

namespace mercury::fuzz {
namespace {

// Scores without a simulation.
class DrawnScores : public Assessor {
 public:
  std::optional<std::vector<Assessment>> assess(std::span<const GenomePointer> candidates, std::span<const double>,
                                                const Watch&) override {
    std::vector<Assessment> assessments;
    for (const GenomePointer& genome : candidates) {
      Random random(genome->identity());
      Assessment assessment{.fate = random.below(4) == 0 ? Fate::failed : Fate::sound, .hash = genome->identity()};
      if (assessment.fate == Fate::failed) assessment.problem = "a problem";
      assessment.scores = {assessment.fate == Fate::failed ? worst_score : random.uniform(0, 1)};
      if (assessment.fate != Fate::failed) assessment.values.assign(quantities().size(), random.uniform(0, 1));
      assessments.push_back(assessment);
    }
    return assessments;
  }
  std::string device_name() const override { return "none"; }
};

RunSettings settings(const std::string& algorithm) {
  RunSettings settings{.program = "a test"};
  settings.evolution.algorithm = {.name = algorithm, .population = 3};
  settings.evolution.generations = 2;
  if (algorithm_named(algorithm).of_behavior)
    settings.evolution.algorithm.axes = {{.quantity = "size", .lowest = -1, .highest = 1, .cells = 4}};
  return settings;
}

// Its genomes have a step.
const GenomeSpaceRequest adaptive{.genes = Genes::muscles, .muscles = {.muscle_adaptation = true, .muscle_tail = 1}};
// Its brains have neurons and connections.
const GenomeSpaceRequest growing{.kind = "tapered",
                                 .genes = Genes::muscles | Genes::brain,
                                 .growth = {.brain_growth = true, .new_neurons = 0.5, .new_connections = 0.5}};
// Their muscles are fields.
const GenomeSpaceRequest painted_fields{
    .kind = "cppn",
    .values = {{"painted_muscles", std::string("fields")}, {"muscle_frequencies", std::int64_t{2}}},
    .genes = Genes::both};
const GenomeSpaceRequest network_fields{
    .kind = "nn", .values = {{"network_muscles", std::string("fields")}}, .genes = Genes::both};

// A brain that grows around gates.
GenomeSpaceRequest growing_gates() {
  VoxelGrid grid(2, 1, 1);
  for (int x = 0; x < 2; ++x) grid.cell(x, 0, 0) = static_cast<MaterialId>(1 + x);
  Robot robot = make_voxel_robot(grid);
  const auto muscles = static_cast<std::uint32_t>(actuators_of(robot).size());
  robot.sensors = {{.kind = SensorKind::clock, .frequency = 3}};
  robot.brain.emplace().layers = {
      {.name = "gate", .neurons = muscles, .activation = Activation::sigmoid, .inputs = {{.from = "motor"}}},
      {.name = "motor", .neurons = muscles, .inputs = {{.from = "senses"}}, .gate = "gate", .keep = {0.5f}}};
  robot.brain->layers[0].inputs[0].weights.assign(muscles * muscles, 0.5f);
  robot.brain->layers[1].inputs[0].weights.assign(2 * muscles, 0.5f);
  return {.genes = Genes::brain, .founders = {robot}, .growth = growing.growth};
}

RunSettings island_run() {
  RunSettings islands = settings("afpo");
  islands.evolution.algorithm.population = 6;
  islands.evolution.algorithm.islands = 2;
  islands.evolution.algorithm.migration_interval = 1;
  islands.evolution.algorithm.migrants = 1;
  return islands;
}
// Of brains that grow, in species.
RunSettings neat_run() {
  RunSettings neat = settings("neat");
  neat.evolution.algorithm.population = 4;
  neat.space = growing;
  return neat;
}

// A run folder of three generations.
std::filesystem::path made_folder(const std::string& name, const RunSettings& wanted) {
  const std::filesystem::path made = scratch_folder() + "/" + name;
  RunFolder run = RunFolder::create(made, wanted);
  Evolution evolution(run.history().settings().evolution, run.space());
  DrawnScores scores;
  while (const std::optional<Generation> generation = evolution.advance(scores))
    run.append(*generation, {.seconds = 0.5, .device = "none"});
  return made;
}
const std::filesystem::path& run_folder(bool of_neat) {
  static const std::filesystem::path islands = made_folder("run", island_run()), neat = made_folder("neat", neat_run());
  return of_neat ? neat : islands;
}

}  // namespace

void check_run_file(std::string_view input) {
  const std::filesystem::path folder = scratch_folder();
  const RunFile file = parse_run_file(folder, {.run = std::string(input), .founders = {}});
  validate(file.settings.evolution);
  const RunFileTexts written = run_file_texts(file.settings);
  const RunFile again = parse_run_file(folder, written);
  require(run_file_texts(again.settings).run == written.run, "run.toml does not read back as it was written");
  with_generations(folder, std::string(input), 7);
}

std::vector<std::string> run_file_seeds() {
  std::vector<std::string> seeds;
  for (const char* algorithm : {"afpo", "nsga2", "map-elites", "novelty", "alps", "neat"})
    seeds.push_back(run_file_texts(settings(algorithm)).run);
  RunSettings land = settings("ga");
  land.evolution.configuration.environment = Land{};
  land.space.kind = "cppn";
  seeds.push_back(run_file_texts(land).run);
  seeds.push_back(run_file_texts(neat_run()).run);
  for (const GenomeSpaceRequest& fields : {painted_fields, network_fields}) {
    RunSettings of_fields = settings("ga");
    of_fields.space = fields;
    seeds.push_back(run_file_texts(of_fields).run);
  }
  return seeds;
}

// The first byte chooses: a whole journal of one run or the other, or the index of a record, preceded by two bytes for
// the size of its genomes.
void check_journal(std::string_view input) {
  if (input.empty()) return;
  const std::string_view rest = input.substr(1);
  if (input[0] % 2 == 0) {
    const std::filesystem::path& folder = run_folder(input[0] % 4 != 0);
    std::ofstream(folder / journal_name, std::ios::binary | std::ios::trunc)
        .write(rest.data(), static_cast<std::streamsize>(rest.size()));
    const RunHistory history(folder);
    for (const Individual& individual : history.individuals()) history.genome(individual.id);
    history.species();
    return;
  }
  if (rest.size() < 2) return;
  const std::uint64_t genomes_size = 256u * static_cast<unsigned char>(rest[0]) + static_cast<unsigned char>(rest[1]);
  try {
    const GenerationRecord record = decode_index(rest.substr(2), 0, 0, genomes_size);
    const std::string written = encode_index(record);
    require(encode_index(decode_index(written, 0, 0, genomes_size)) == written,
            "an index does not read back as it was written");
  } catch (const DamagedBytes& error) {
    throw InputError(error.what());
  }
}

std::vector<std::string> journal_seeds() {
  static const std::string journal = content_of((run_folder(false) / journal_name).string()),
                           of_neat = content_of((run_folder(true) / journal_name).string());
  const std::size_t mark = journal.find(head_mark);
  const RecordHead head = decode_head(std::string_view(journal).substr(mark, RecordHead::size)).value();
  const std::string index = journal.substr(mark + RecordHead::size, head.index_size);
  return {std::string(1, '\0') + journal, '\2' + of_neat,
          std::string{'\1', static_cast<char>(head.genomes_size / 256), static_cast<char>(head.genomes_size % 256)} +
              index};
}

// The first byte chooses the kind.
void check_genome(std::string_view input) {
  static const std::vector<std::unique_ptr<GenomeSpace>> spaces = [] {
    std::vector<std::unique_ptr<GenomeSpace>> made;
    for (const char* kind : {"voxel", "cppn", "nn", "shell", "tapered"})
      made.push_back(make_genome_space({.kind = kind}));
    made.push_back(make_genome_space(adaptive));
    made.push_back(make_genome_space(growing));
    made.push_back(make_genome_space(painted_fields));
    made.push_back(make_genome_space(network_fields));
    made.push_back(make_genome_space(growing_gates()));
    return made;
  }();
  if (input.empty()) return;
  const GenomeSpace& space = *spaces[static_cast<unsigned char>(input[0]) % spaces.size()];
  const GenomePointer genome = space.decode(input.substr(1));
  const std::string written = genome->encode();
  const GenomePointer again = space.decode(written);
  require(again->encode() == written, "a genome does not read back as it was written");
  require(again->identity() == genome->identity(), "a genome has another identity when it is read again");
  genome->mutate(1, 1);
  genome->cross(*again, 1);
  genome->distance(*again);
}

std::vector<std::string> genome_seeds() {
  std::vector<std::string> seeds;
  char choice = 0;
  for (const char* kind : {"voxel", "cppn", "nn", "shell", "tapered"}) {
    const auto space = make_genome_space({.kind = kind});
    seeds.push_back(choice++ + space->random(1, 0)->encode());
  }
  seeds.push_back(choice++ + make_genome_space(adaptive)->random(1, 0)->mutate(1, 1)->encode());
  const auto add_grown = [&](const GenomeSpaceRequest& request) {
    GenomePointer grown = make_genome_space(request)->random(1, 0);
    for (std::uint64_t seed = 0; seed < 6; ++seed) grown = grown->mutate(1, seed);
    seeds.push_back(choice++ + grown->encode());
  };
  add_grown(growing);
  for (const GenomeSpaceRequest& fields : {painted_fields, network_fields})
    seeds.push_back(choice++ + make_genome_space(fields)->random(1, 0)->mutate(1, 1)->encode());
  add_grown(growing_gates());
  return seeds;
}

}  // namespace mercury::fuzz
