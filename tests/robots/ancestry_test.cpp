// SPDX-License-Identifier: Apache-2.0
// The ancestry in a robot's origin.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "mercury/error.h"
#include "mercury/origin.h"
#include "mercury/random.h"
#include "tests/refusal.h"

namespace mercury {
namespace {

const Ancestry full{.parents = {"a", "the \"b\" {"},
                    .crossover_seed = 3,
                    .mutation_seed = 18446744073709551615u,
                    .strength = 0.1,
                    .muscles = 2,
                    .generation = 12};

std::string refusal_of_origin(const std::string& origin) {
  return refusal([&] { ancestry_of({.origin = origin}); });
}

TEST(Ancestry, ReadsBackAsItWasWritten) {
  for (const std::string origin : {"", "{}", " { } ", R"({"kind":"voxel","cells":[1,[2],{"ancestry":3}]})"}) {
    EXPECT_EQ(ancestry_of({.origin = with_ancestry(origin, full)}), full) << origin;
    EXPECT_EQ(ancestry_of({.origin = with_ancestry(origin, {})}), Ancestry{}) << origin;
  }
}

TEST(Ancestry, OfOneThatHasNoneIsNone) {
  for (const std::string origin : {"", "{}", R"({"kind":"voxel","of":{"ancestry":3},"is":"ancestry"})"})
    EXPECT_EQ(ancestry_of({.origin = origin}), std::nullopt) << origin;
}

TEST(Ancestry, LeavesEverythingElseAsItIs) {
  const std::string origin = R"({"kind":"nn","weights":[1.000000001, -0.0,1e-45],"note":"\\\"ancestry\\\":{","x":{}})";
  const std::string text = with_ancestry(origin, full);
  EXPECT_EQ(text.substr(0, origin.size() - 1), origin.substr(0, origin.size() - 1));
  EXPECT_TRUE(nlohmann::json::accept(text));
}

TEST(Ancestry, ReplacesTheOneBefore) {
  const std::string plain = with_ancestry(R"({"kind":"nn","x":[1]})", {});
  for (const std::string origin : {
           R"({"kind":"nn","x":[1],"ancestry":{"parents":["a,}]","b"],"more":[[{}]]}})",
           R"({"ancestry":{"parents":[]},"kind":"nn","x":[1]})",
           R"({"kind":"nn","ancestry":[3],"x":[1]})",
           R"({"kind":"nn","ancestry":"no","x":[1],"ancestry":7})",
       })
    EXPECT_EQ(with_ancestry(origin, {}), plain) << origin;
  EXPECT_EQ(with_ancestry(with_ancestry("", full), {}), with_ancestry("", {}));
}

TEST(Ancestry, ThatCannotBeUsedIsRefusedWithItsPlace) {
  EXPECT_EQ(refusal_of_origin(R"({"ancestry":3})"), "/origin/ancestry: a JSON object is expected");
  EXPECT_EQ(refusal_of_origin(R"({"ancestry":{}})"), "/origin/ancestry/parents: is missing");
  EXPECT_EQ(refusal_of_origin(R"({"ancestry":{"parents":"a"}})"),
            "/origin/ancestry/parents: an array of names is expected");
  EXPECT_EQ(refusal_of_origin(R"({"ancestry":{"parents":["a",3]}})"), "/origin/ancestry/parents/1: a name is expected");
  EXPECT_EQ(refusal_of_origin(with_ancestry("", {.parents = std::vector<std::string>(17, "a")})),
            "/origin/ancestry/parents: at most 16 names are accepted");
  EXPECT_EQ(refusal_of_origin(R"({"ancestry":{"parents":[],"mutation_seed":-1}})"),
            "/origin/ancestry/mutation_seed: a whole number >= 0 is expected");
  EXPECT_EQ(refusal_of_origin(R"({"ancestry":{"parents":[],"strength":"strong"}})"),
            "/origin/ancestry/strength: a number >= 0 is expected");
  EXPECT_EQ(refusal_of_origin(R"(["ancestry"])"), "/origin: a JSON object is expected");
  for (const std::string origin : {"3", "[1]", "x", "}", "{"}) EXPECT_THROW(with_ancestry(origin, {}), InputError);
}

// Each took time with the square of the number, minutes here.
TEST(Ancestry, TakesTimeInProportionToTheOrigin) {
  constexpr int many = 200'000;
  std::string objects, ancestries;
  for (int i = 0; i < many; ++i) {
    objects += (i == 0 ? "\"" : ",\"") + std::to_string(i) + "\":{}";
    ancestries += "\"ancestry\":{},";
  }
  EXPECT_EQ(kind_of({.origin = "{\"kind\":{" + objects + "}}"}), "");
  EXPECT_EQ(refusal_of_origin("{\"ancestry\":{" + objects + "}}"), "/origin/ancestry/parents: is missing");
  EXPECT_EQ(with_ancestry("{" + ancestries + "\"kind\":\"nn\"}", {}), with_ancestry(R"({"kind":"nn"})", {}));
}

// Either the damaged text is refused in one line, or it has an ancestry that can be replaced.
TEST(Ancestry, SurvivesDamage) {
  const std::string whole = with_ancestry(R"({"kind":"nn","weights":[[1,2],{"a":"b\\"}]})", full);
  Random random(1);
  int refused = 0, usable = 0;
  for (int trial = 0; trial < 5000; ++trial) {
    std::string text = whole;
    for (std::uint64_t edits = 1 + random.below(3); edits > 0; --edits) {
      const std::size_t at = random.below(text.size());
      if (random.chance(0.5))
        text[at] = "{}[],:\"\\0a\xff"[random.below(11)];
      else
        text.erase(at, 1 + random.below(4));
    }
    try {
      ancestry_of({.origin = text});
      EXPECT_EQ(ancestry_of({.origin = with_ancestry(text, {})}), Ancestry{});
      ++usable;
    } catch (const InputError& error) {
      EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
      ++refused;
    }
  }
  EXPECT_GT(refused, 1000);
  EXPECT_GT(usable, 100);
}

}  // namespace
}  // namespace mercury
