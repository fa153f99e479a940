// SPDX-License-Identifier: Apache-2.0
// Robot documents that break a rule are refused in one line that says where and why.
#include <gtest/gtest.h>

#include <map>

#include "mercury/random.h"
#include "mercury/robot_file.h"
#include "tests/refusal.h"

namespace mercury {
namespace {

std::string refusal_of_document(std::string_view document, RobotFormat format) {
  return refusal([&] { parse_robot(document, format); });
}

std::string refusal_of_json(std::string_view document) { return refusal_of_document(document, RobotFormat::json); }

// A valid document whose parts can be replaced.
struct Parts {
  std::string head = R"("format":"mercury-robot","version":1)";
  std::string masses = "[[0,0,0],[1,0,0],[0,1,0]]";
  std::string springs = "[[0,1,1],[1,2,1]]";
  std::string faces = "[[0,1,2]]";
  std::string rest;
};

std::string refusal_of(const Parts& parts) {
  return refusal_of_json("{" + parts.head + ",\"masses\":" + parts.masses + ",\"springs\":" + parts.springs +
                         ",\"faces\":" + parts.faces + parts.rest + "}");
}

TEST(BadRobotFiles, TheValidDocumentIsAccepted) { EXPECT_EQ(refusal_of({}), ""); }

TEST(BadRobotFiles, NotJson) {
  const std::string sound = R"({"format":"mercury-robot","version":1,"masses":[[0,0,0]],"springs":[],"faces":[]})"
                            "\n";
  EXPECT_EQ(refusal_of_json(sound), "");
  EXPECT_EQ(refusal_of_json(""), "line 1, column 0: not valid JSON: unexpected end of input");
  EXPECT_EQ(refusal_of_json("hello"), "line 1, column 1: not valid JSON: invalid literal");
  EXPECT_EQ(refusal_of_json("{\"format\":\"mercury-robot\",\n\"masses\":[[0,0"),
            "line 2, column 14: not valid JSON: unexpected end of input");
  EXPECT_EQ(refusal_of_json("{} {}"), "line 1, column 4: not valid JSON: unexpected '{'");
  EXPECT_EQ(refusal_of_json("{\"a\":\"\xff\"}"),
            "line 1, column 7: not valid JSON: invalid string: ill-formed UTF-8 byte");
  EXPECT_EQ(refusal_of({.masses = "[[0,0,NaN]]"}), "line 1, column 54: not valid JSON: invalid literal");
  EXPECT_EQ(refusal_of_json(std::string(1000, '\0')), "line 1, column 1: not valid JSON: a NUL byte");
  EXPECT_EQ(refusal_of_json(sound + std::string(1, '\0')), "line 2, column 1: not valid JSON: a NUL byte");
  EXPECT_EQ(refusal_of_json(sound + std::string("\0{]", 3)), "line 2, column 1: not valid JSON: a NUL byte");
  EXPECT_EQ(refusal_of_json(std::string("{\"a\":\"\0\"}", 9)), "line 1, column 7: not valid JSON: a NUL byte");
}

TEST(BadRobotFiles, NotARobot) {
  EXPECT_EQ(refusal_of_json("[]"), "not a Mercury robot: the document must be an object");
  EXPECT_EQ(refusal_of_json("3"), "not a Mercury robot: the document must be an object");
  EXPECT_EQ(refusal_of_json("{}"), "not a Mercury robot: \"format\": \"mercury-robot\" is missing");
  EXPECT_EQ(refusal_of_json(R"({"format":"glTF"})"), "/format: \"glTF\" is not known; give \"mercury-robot\"");
  EXPECT_EQ(refusal_of_json(R"({"format":7})"), "/format: must be a text, not a number");
  EXPECT_EQ(refusal_of_json(R"({"format":"mercury-robot"})"), "/version: is missing");
  EXPECT_EQ(refusal_of({.head = R"("format":"mercury-robot","version":2)"}),
            "/version: 2 is not known; this program reads version 1");
  EXPECT_EQ(refusal_of({.head = R"("format":"mercury-robot","version":1.0)"}),
            "/version: 1.0 is not known; this program reads version 1");
  EXPECT_EQ(refusal_of({.head = R"("format":"mercury-robot","version":"1")"}),
            "/version: must be a whole number, not a text");
  EXPECT_EQ(refusal_of_json(R"({"format":"mercury-robot","version":1,"masses":[[0,0,0]]})"), "/springs: is missing");
}

TEST(BadRobotFiles, KeysThatAppearTwice) {
  EXPECT_EQ(refusal_of({.rest = R"(,"masses":[[5,5,5]])"}), "/masses: appears twice");
  EXPECT_EQ(refusal_of({.rest = R"(,"materials":[{"stiffness":1,"stiffness":2}])"}),
            "/materials/0/stiffness: appears twice");
}

TEST(BadRobotFiles, Masses) {
  EXPECT_EQ(refusal_of({.masses = "null"}), "/masses: must be an array, not null");
  EXPECT_EQ(refusal_of({.masses = "{}"}), "/masses: must be an array, not an object");
  EXPECT_EQ(refusal_of({.masses = "[]"}), "/masses: a robot needs at least one mass");
  EXPECT_EQ(refusal_of({.masses = "[[0,0,0],7]"}), "/masses: holds a number at 1, not an array");
  EXPECT_EQ(refusal_of({.masses = "[[0,0]]"}), "/masses/0: a mass has three coordinates [x, y, z]");
  EXPECT_EQ(refusal_of({.masses = "[[0,0,0,0]]"}), "/masses/0: a mass has three coordinates [x, y, z]");
  EXPECT_EQ(refusal_of({.masses = "[[0,0,0],[0,null,0]]"}), "/masses/1: must hold numbers, not null");
  EXPECT_EQ(refusal_of({.masses = "[[0,0,[0]]]"}), "/masses/0: must hold numbers, not an array");
  EXPECT_EQ(refusal_of({.masses = "[[0,0,\"1\"]]"}), "/masses/0: must hold numbers, not a text");
  EXPECT_EQ(refusal_of({.masses = "[[0,0,1e39]]"}), "/masses/0: 1e39 is not a finite 32-bit number");
  EXPECT_EQ(refusal_of({.masses = "[[0,0,-1e999]]"}), "/masses/0: -1e999 is not a finite 32-bit number");
  EXPECT_EQ(refusal_of({.masses = "[[0,0,2e6]]"}),
            "/masses/0: a position must be finite and within 1e6 m of the origin");
  std::string many = "[[0,0,0]";
  for (int i = 0; i < 65535; ++i) many += ",[0,0,0]";
  EXPECT_EQ(refusal_of({.masses = many + "]"}), "/masses: more than 65535 masses, at most 65535 are accepted");
}

TEST(BadRobotFiles, Springs) {
  EXPECT_EQ(refusal_of({.springs = "[[0,1,1],[0,912,1]]"}), "/springs/1: mass 912 is out of range, the robot has 3");
  EXPECT_EQ(refusal_of({.springs = "[[-1,1,1]]"}), "/springs/0: mass -1 is out of range, the robot has 3");
  EXPECT_EQ(refusal_of({.springs = "[[0,70000,1]]"}), "/springs/0: mass 70000 is out of range, the robot has 3");
  EXPECT_EQ(refusal_of_json(R"({"springs":[[0,70000,1]]})"),
            "/springs/0: mass 70000 is out of range, a robot has at most 65535");
  EXPECT_EQ(refusal_of({.springs = "[[0,1.5,1]]"}), "/springs/0: a mass is given by a whole number");
  EXPECT_EQ(refusal_of({.springs = "[[0,18446744073709551616,1]]"}), "/springs/0: a mass is given by a whole number");
  EXPECT_EQ(refusal_of({.springs = "[[1,1,1]]"}), "/springs/0: joins mass 1 to itself");
  EXPECT_EQ(refusal_of({.springs = "[[0,1,0]]"}), "/springs/0: material 0 is air, a spring needs another");
  EXPECT_EQ(refusal_of({.springs = "[[0,1,254]]"}), "/springs/0: material 254 is out of range, the table has 254");
  EXPECT_EQ(refusal_of({.springs = "[[0,1,300]]"}), "/springs/0: material 300 is out of range, the table has 254");
  EXPECT_EQ(refusal_of({.springs = "[[0,1,-3]]"}), "/springs/0: material -3 is out of range, the table has 254");
  EXPECT_EQ(refusal_of({.springs = "[[0,1,1,0.0009]]"}),
            "/springs/0: rest length 0.000900 m, at least 0.001 m is accepted");
  EXPECT_EQ(refusal_of({.masses = "[[0,0,0],[0.0005,0,0],[1,1,1]]"}),
            "/springs/0: rest length 0.000500 m, at least 0.001 m is accepted");
  EXPECT_EQ(refusal_of({.springs = "[[0,1,1,null]]"}),
            "/springs/0: the rest length must be a number, not null; leave it out for the distance at rest");
  EXPECT_EQ(refusal_of({.springs = "[[0,1]]"}),
            "/springs/0: a spring is [a, b, material] or [a, b, material, rest_length]");
  EXPECT_EQ(refusal_of({.springs = "[[0,1,1,1,1]]"}),
            "/springs/0: a spring is [a, b, material] or [a, b, material, rest_length]");
  EXPECT_EQ(refusal_of({.springs = "[{\"a\":0}]"}), "/springs: holds an object at 0, not an array");
}

TEST(BadRobotFiles, Faces) {
  EXPECT_EQ(refusal_of({.faces = "[[0,1,3]]"}), "/faces/0: mass 3 is out of range, the robot has 3");
  EXPECT_EQ(refusal_of({.faces = "[[0,1,1]]"}), "/faces/0: a face needs three different masses");
  EXPECT_EQ(refusal_of({.faces = "[[0,1]]"}), "/faces/0: a face has three masses [a, b, c]");
  EXPECT_EQ(refusal_of({.faces = "[[0,1,2,0]]"}), "/faces/0: a face has three masses [a, b, c]");
}

TEST(BadRobotFiles, Mass) {
  const auto mass = [](const std::string& list) { return refusal_of({.rest = ",\"mass\":" + list}); };
  EXPECT_EQ(mass("[1,0.5,2]"), "");
  EXPECT_EQ(mass("3"), "/mass: must be an array, not a number");
  EXPECT_EQ(mass("[]"), "/mass: an empty list; leave it out for 1 kg per mass");
  EXPECT_EQ(mass("[1,1]"), "/mass: 2 numbers, the robot has 3 masses");
  EXPECT_EQ(mass("[1,1,1,1]"), "/mass: 4 numbers, the robot has 3 masses");
  EXPECT_EQ(mass("[1,0,1]"), "/mass/1: a mass must be a finite number above 0 kg");
  EXPECT_EQ(mass("[1,1,-2]"), "/mass/2: a mass must be a finite number above 0 kg");
  EXPECT_EQ(mass("[1,1,1e39]"), "/mass/2: 1e39 is not a finite 32-bit number");
  EXPECT_EQ(mass("[1,null,1]"), "/mass/1: must be a number, not null");
  EXPECT_EQ(mass("[1,\"1\",1]"), "/mass/1: must be a number, not a text");
  EXPECT_EQ(mass("[[1],1,1]"), "/mass/0: must be a number, not an array");
  EXPECT_EQ(mass("[{}]"), "/mass/0: must be a number, not an object");
  EXPECT_EQ(mass("[true]"), "/mass/0: must be a number, not true");
  EXPECT_EQ(mass("[1,1,1],\"mass\":[1,1,1]"), "/mass: appears twice");
  std::string many = "[1";
  for (int i = 0; i < 65535; ++i) many += ",1";
  EXPECT_EQ(mass(many + "]"), "/mass: more than 65535 elements, at most 65535 are accepted");
}

TEST(BadRobotFiles, VelocityAndFixed) {
  const auto velocity = [](const std::string& list) { return refusal_of({.rest = ",\"velocity\":" + list}); };
  EXPECT_EQ(velocity("[[0,0,0],[0,0,1],[0,0,0]]"), "");
  EXPECT_EQ(velocity("[]"), "/velocity: an empty list; leave it out for a robot at rest");
  EXPECT_EQ(velocity("[[0,0,0]]"), "/velocity: 1 vectors, the robot has 3 masses");
  EXPECT_EQ(velocity("[[0,0,0],[0,0]]"), "/velocity/1: a velocity has three components [x, y, z]");
  EXPECT_EQ(velocity("[[0,0,0,0]]"), "/velocity/0: a velocity has three components [x, y, z]");
  EXPECT_EQ(velocity("[[0,0,0],7]"), "/velocity: holds a number at 1, not an array");
  EXPECT_EQ(velocity("[[0,0,\"x\"]]"), "/velocity/0: must hold numbers, not a text");
  EXPECT_EQ(velocity("[[0,0,1e39]]"), "/velocity/0: 1e39 is not a finite 32-bit number");
  const auto fixed = [](const std::string& list) { return refusal_of({.rest = ",\"fixed\":" + list}); };
  EXPECT_EQ(fixed("[]"), "");
  EXPECT_EQ(fixed("[2,0]"), "");
  EXPECT_EQ(fixed("[0,3]"), "/fixed/1: mass 3 is out of range, the robot has 3");
  EXPECT_EQ(fixed("[0,70000]"), "/fixed/1: mass 70000 is out of range, the robot has 3");
  EXPECT_EQ(fixed("[-1]"), "/fixed/0: mass -1 is out of range, the robot has 3");
  EXPECT_EQ(fixed("[1,2,1]"), "/fixed/2: mass 1 is listed twice");
  EXPECT_EQ(fixed("[1.5]"), "/fixed/0: a mass is given by a whole number");
  EXPECT_EQ(fixed("[\"0\"]"), "/fixed/0: must be a whole number, not a text");
  EXPECT_EQ(fixed("[[0]]"), "/fixed/0: must be a whole number, not an array");
}

TEST(BadRobotFiles, WhatAFileRequires) {
  const auto refusal = [](const std::string& list) { return refusal_of({.rest = ",\"requires\":" + list}); };
  EXPECT_EQ(refusal("[]"), "");
  EXPECT_EQ(refusal(R"(["mass","velocity","fixed","relaxation_time"])"), "");
  EXPECT_EQ(refusal(R"(["mass","wings"])"),
            "/requires/1: requires \"wings\", which this version does not know; it knows mass, velocity, fixed, "
            "relaxation_time, modulus, brain, gates");
  EXPECT_EQ(refusal("\"mass\""), "/requires: must be an array, not a text");
  EXPECT_EQ(refusal("[1]"), "/requires/0: must be a text, not a number");
  EXPECT_EQ(refusal("[[]]"), "/requires/0: must be a text, not an array");
  // A later version may change what a member is; the file says so before it.
  EXPECT_EQ(refusal_of({.head = R"("format":"mercury-robot","version":1,"requires":["wings"])", .masses = "{}"}),
            "/requires/0: requires \"wings\", which this version does not know; it knows mass, velocity, fixed, "
            "relaxation_time, modulus, brain, gates");
}

TEST(BadRobotFiles, RelaxationTimes) {
  const auto refusal = [](const std::string& value) {
    return refusal_of({.rest = R"(,"materials":[{"stiffness":0},{"stiffness":1,"relaxation_time":)" + value + "}]"});
  };
  EXPECT_EQ(refusal("0.01"), "");
  EXPECT_EQ(refusal("true"), "/materials/1/relaxation_time: must be a number, not true");
  EXPECT_EQ(refusal("\"1\""), "/materials/1/relaxation_time: must be a number, not a text");
  EXPECT_EQ(refusal("-0.01"), "/materials/1: relaxation_time must be a finite number >= 0 s");
  EXPECT_EQ(refusal("1e39"), "/materials/1/relaxation_time: 1e39 is not a finite 32-bit number");
  EXPECT_EQ(refusal("0,\"relaxation_time\":0"), "/materials/1/relaxation_time: appears twice");
}

TEST(BadRobotFiles, MaterialsNamesAndOrigin) {
  EXPECT_EQ(refusal_of({.rest = R"(,"materials":[])"}),
            "/materials: an empty table; leave it out for the 254 defaults");
  EXPECT_EQ(refusal_of({.rest = R"(,"materials":[1])"}), "/materials: holds a number at 0, not an object");
  EXPECT_EQ(refusal_of({.rest = R"(,"materials":[{}])"}), "/materials/0: stiffness or modulus is missing");
  EXPECT_EQ(refusal_of({.rest = R"(,"materials":[{"stiffness":"x"}])"}),
            "/materials/0/stiffness: must be a number, not a text");
  EXPECT_EQ(refusal_of({.rest = R"(,"materials":[{"stiffness":0,"name":3}])"}),
            "/materials/0/name: must be a text, not a number");
  EXPECT_EQ(refusal_of({.rest = R"(,"materials":[{"stiffness":0},{"stiffness":-5}])"}),
            "/materials/1: stiffness must be a finite number >= 0 N/m");
  EXPECT_EQ(refusal_of({.rest = R"(,"materials":[{"stiffness":0},{"stiffness":1,"half_wave":false}])"}), "");
  const auto half_wave = [](const std::string& value) {
    return refusal_of({.rest = R"(,"materials":[{"stiffness":0},{"half_wave":)" + value + R"(,"stiffness":1}])"});
  };
  for (const auto& [value, named] : std::map<std::string, std::string>{{"1", "a number"},
                                                                       {"0.0", "a number"},
                                                                       {"\"true\"", "a text"},
                                                                       {"null", "null"},
                                                                       {"[true]", "an array"},
                                                                       {"{}", "an object"}})
    EXPECT_EQ(half_wave(value), "/materials/1/half_wave: must be true or false, not " + named);
  EXPECT_EQ(half_wave("true,\"half_wave\":true"), "/materials/1/half_wave: appears twice");
  EXPECT_EQ(refusal_of({.rest = R"(,"materials":[{"stiffness":true}])"}),
            "/materials/0/stiffness: must be a number, not true");
  std::string many = R"(,"materials":[{"stiffness":0})";
  for (int i = 0; i < 256; ++i) many += R"(,{"stiffness":0})";
  EXPECT_EQ(refusal_of({.rest = many + "]"}), "/materials: more than 256 materials, at most 256 are accepted");
  EXPECT_EQ(refusal_of({.rest = R"(,"name":["eel"])"}), "/name: must be a text, not an array");
  EXPECT_EQ(refusal_of({.rest = R"(,"origin":"a text")"}), "/origin: must be an object, not a text");
  EXPECT_EQ(refusal_of({.rest = R"(,"origin":{"w":1e999})"}), "/origin: a number is not finite");
}

TEST(BadRobotFiles, DeepNesting) {
  const std::string deep(10'000'000, '[');
  EXPECT_EQ(refusal_of_json(deep), "not a Mercury robot: the document must be an object");
  EXPECT_EQ(refusal_of_json("{\"x\":" + deep), "nested deeper than 64 levels");
  EXPECT_EQ(refusal_of_json("{\"origin\":{\"x\":" + deep), "nested deeper than 64 levels");
}

std::string refusal_of_cbor(std::string_view document) { return refusal_of_document(document, RobotFormat::cbor); }

// A map with one pair; "masses" stands in it with the CBOR item given.
std::string cbor_masses(std::string_view item) { return std::string("\xa1\x66masses").append(item); }

TEST(BadRobotFiles, Cbor) {
  using namespace std::string_literals;
  EXPECT_EQ(refusal_of_cbor(""), "byte 0: the CBOR document breaks off");
  EXPECT_EQ(refusal_of_cbor("\x18"), "byte 1: the CBOR document breaks off");
  EXPECT_EQ(refusal_of_cbor("\x1c"), "byte 0: not valid CBOR");
  EXPECT_EQ(refusal_of_cbor("\xff"), "byte 0: not valid CBOR");
  EXPECT_EQ(refusal_of_cbor("\xa0"), "not a Mercury robot: \"format\": \"mercury-robot\" is missing");
  EXPECT_EQ(refusal_of_cbor("\xa0\x00"s), "byte 1: more follows the end of the document");
  EXPECT_EQ(refusal_of_cbor("\xa1\x01\x01"), "byte 1: a key must be text");
  EXPECT_EQ(refusal_of_cbor("\xa1\x66mass"), "byte 1: the CBOR document breaks off");
  EXPECT_EQ(refusal_of_cbor("\xa1\x64name\x61\xff"), "a text is not valid UTF-8");
  EXPECT_EQ(refusal_of_cbor("\xa1\x64name\x41x"), "/name: must be a text, not a byte string");
  EXPECT_EQ(refusal_of_cbor(cbor_masses("\x81\x83\x00\x00\xf9\x7e\x00"s)),
            "/masses/0: a number is not a finite 32-bit number");
  EXPECT_EQ(refusal_of_cbor(cbor_masses("\x81\x83\x00\x00\xfb\x7f\xf0\x00\x00\x00\x00\x00\x00"s)),
            "/masses/0: a number is not a finite 32-bit number");
}

TEST(BadRobotFiles, CborThatAnnouncesMoreThanItHolds) {
  using namespace std::string_literals;
  EXPECT_EQ(refusal_of_cbor(cbor_masses("\x9a\x00\x0f\x42\x40"s)),
            "/masses: 1000000 masses, at most 65535 are accepted");
  EXPECT_EQ(refusal_of_cbor(cbor_masses("\x9b\xff\xff\xff\xff\xff\xff\xff\xff"s)),
            "byte 8: the CBOR document breaks off");
  EXPECT_EQ(refusal_of_cbor("\xa1\x64mass\x9a\x00\x0f\x42\x40"s),
            "/mass: 1000000 elements, at most 65535 are accepted");
  EXPECT_EQ(refusal_of_cbor("\xa1\x65"
                            "fixed\x9a\x00\x0f\x42\x40"s),
            "/fixed: 1000000 elements, at most 65535 are accepted");
  EXPECT_EQ(refusal_of_cbor("\xa1\x68velocity\x9a\x00\x0f\x42\x40"s),
            "/velocity: 1000000 elements, at most 65535 are accepted");
  EXPECT_EQ(refusal_of_cbor("\xa1\x67springs\x9b\x00\x00\x00\xff\xff\xff\xff\xff"s),
            "byte 9: the CBOR document breaks off");
  EXPECT_EQ(refusal_of_cbor("\xa1\x64name\x7b\x00\x00\x00\xff\xff\xff\xff\xff"s),
            "byte 6: the CBOR document breaks off");
  EXPECT_EQ(refusal_of_cbor("\xbb\x7f\xff\xff\xff\xff\xff\xff\xff"s), "byte 0: the CBOR document breaks off");
}

TEST(BadRobotFiles, Noise) {
  for (const RobotFormat format : {RobotFormat::json, RobotFormat::cbor})
    for (std::uint64_t seed = 0; seed < 2000; ++seed) {
      Random random(seed);
      std::string noise(random.below(200), '\0');
      for (char& c : noise) c = static_cast<char>(random.below(256));
      ASSERT_NE(refusal_of_document(noise, format), "") << "seed " << seed;
    }
}

TEST(BadRobotFiles, CborThatNestsDeeply) {
  for (const char opening : {'\x81', '\x9f'})
    EXPECT_EQ(refusal_of_cbor("\xa1\x61x" + std::string(10'000'000, opening)), "byte 66: nested deeper than 64 levels");
  EXPECT_EQ(refusal_of_cbor("\xa1\x61x" + std::string(10'000'000, '\x7f')), "byte 4: not valid CBOR");
  EXPECT_EQ(refusal_of_cbor("\xa1\x61x" + std::string(10'000'000, '\xc1')),
            "byte 10000003: the CBOR document breaks off");
}

}  // namespace
}  // namespace mercury
