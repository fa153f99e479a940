// SPDX-License-Identifier: Apache-2.0
#include "robots/file/inner_members.h"

#include <algorithm>
#include <iterator>
#include <optional>

#include "mercury/brain.h"
#include "mercury/error.h"

namespace mercury {

struct ObjectPlace {
  std::vector<std::string> known;
  std::vector<std::pair<std::string_view, const ObjectPlace*>> objects;  // members that are objects, or lists of these
  bool knows(std::string_view key) const { return std::ranges::find(known, key) != known.end(); }
};

namespace {

std::vector<std::string> keys_of_sensors() {
  std::vector<std::string> keys{"kind", "actuator", "springs", "masses", "layer", "neuron"};
  const Sensor sensor;
  for_each_parameter(sensor, [&](const auto& parameter, float) { keys.emplace_back(parameter.name); });
  return keys;
}

// Unknown members of the document itself are not taken out.
const ObjectPlace& document_place() {
  static const ObjectPlace material{
      {"name", "stiffness", "amplitude", "frequency", "phase", "relaxation_time", "modulus", "density", "half_wave"},
      {}};
  static const ObjectPlace actuator{{"name", "materials", "springs"}, {}};
  static const ObjectPlace sensor{keys_of_sensors(), {}};
  static const ObjectPlace input{{"from", "rate", "weights", "edges"}, {}};
  static const ObjectPlace layer{{"name", "neurons", "activation", "alpha", "gate", "keep", "bias", "inputs"},
                                 {{"inputs", &input}}};
  static const ObjectPlace output{{"actuator", "layer", "neuron"}, {}};
  static const ObjectPlace brain{{"period", "per", "seed", "layers", "outputs"},
                                 {{"layers", &layer}, {"outputs", &output}}};
  static const ObjectPlace document{
      {"materials", "actuators", "sensors", "brain"},
      {{"materials", &material}, {"actuators", &actuator}, {"sensors", &sensor}, {"brain", &brain}}};
  return document;
}

// What is at a member of an object, or in its list.
const ObjectPlace* place_at(const ObjectPlace* place, std::string_view key) {
  if (!place) return nullptr;
  const auto found = std::ranges::find(place->objects, key, [](const auto& object) { return object.first; });
  return found == place->objects.end() ? nullptr : found->second;
}

// Of an object or array that begins within a frame.
template <class Frame>
const ObjectPlace* place_of_next(const std::vector<Frame>& frames, bool is_array) {
  if (frames.empty()) return is_array ? nullptr : &document_place();
  const Frame& outer = frames.back();
  if (outer.is_array) return is_array ? nullptr : outer.place;
  return place_at(outer.place, outer.key);
}

template <class Frame>
std::string name_of_next(const Frame& outer) {
  return outer.is_array ? std::to_string(outer.index) : outer.key;
}

void append_member(std::string& members, std::string_view key, std::string_view value) {
  members.append(members.empty() ? "" : ",").append(json_text(key)).append(":").append(value);
}

}  // namespace

MemberTexts members_of_document(std::string_view other) {
  if (other.empty()) return {};
  MemberTexts members = members_of(other);
  std::erase_if(members, [](const auto& member) { return document_place().knows(member.first); });
  return members;
}

// --- Reading

void InnerMembersReader::on(const Event& event) {
  const int change = event.change_of_depth();
  if (taken_depth_ >= 0) {
    taken_.on(event);
    taken_depth_ += change;
    if (taken_depth_ == 0) end_taken();
    return;
  }
  if (event.begins()) {
    const bool is_array = event.kind == Kind::begin_array;
    if (const ObjectPlace* const place = beyond_ > 0 ? nullptr : place_of_next(frames_, is_array))
      frames_.push_back({.place = place, .is_array = is_array, .index = 0, .key = {}, .members = {}, .inner = {}});
    else
      ++beyond_;
  } else if (event.ends()) {
    close();
  } else if (event.kind == Kind::key && beyond_ == 0) {
    Frame& object = frames_.back();
    if (frames_.size() > 1 && !object.place->knows(event.text)) {
      taken_depth_ = 0;
      return taken_.begin_member(event.text);
    }
    object.key = event.text;
  }
  to_.on(event);
  if (change == 0 && event.kind != Kind::key && beyond_ == 0 && !frames_.empty()) ++frames_.back().index;
}

void InnerMembersReader::close() {
  if (beyond_ > 0) {
    if (--beyond_ == 0 && !frames_.empty()) ++frames_.back().index;
    return;
  }
  const Frame closed = std::move(frames_.back());
  frames_.pop_back();
  if (frames_.empty()) return;
  Frame& outer = frames_.back();
  std::string members;
  for (const auto& [name, object] : closed.inner) append_member(members, name, object);
  if (!closed.members.empty()) members.append(members.empty() ? "" : ",").append(closed.members);
  Inner& inner = frames_.size() > 1 ? outer.inner : of_document_;
  if (!members.empty()) inner[name_of_next(outer)] = "{" + members + "}";
  ++outer.index;
}

// A member that JSON cannot hold is left out.
void InnerMembersReader::end_taken() {
  taken_depth_ = -1;
  const std::string object = taken_.take();
  if (object.empty()) return;
  std::string& members = frames_.back().members;
  members.append(members.empty() ? "" : ",").append(object, 1, object.size() - 2);
}

std::string InnerMembersReader::with_inner(const std::string& other, bool with_materials) const {
  std::string members = other.empty() ? "" : other.substr(1, other.size() - 2);
  for (const auto& [name, object] : of_document_)
    if (with_materials || name != "materials") append_member(members, name, object);
  return members.empty() ? "" : "{" + members + "}";
}

// --- Writing

void InnerMembersWriter::open(bool is_array) {
  Frame frame{.place = place_of_next(frames_, is_array),
              .is_array = is_array,
              .index = 0,
              .key = {},
              .members = {},
              .unknown = {}};
  if (frames_.empty()) {
    frame.members = members_of(other_);
  } else if (frame.place) {
    const MemberTexts& all = frames_.back().members;
    const std::string name = name_of_next(frames_.back());
    const auto found = std::ranges::find(all, name, [](const auto& member) { return member.first; });
    if (found != all.end() && found->second.starts_with('{')) frame.members = members_of(found->second);
    if (!is_array)
      std::ranges::copy_if(frame.members, std::back_inserter(frame.unknown),
                           [&](const auto& member) { return !frame.place->knows(member.first); });
  }
  frames_.push_back(std::move(frame));
}

void InnerMembersWriter::on(const Event& event) {
  if (event.kind == Kind::key) frames_.back().key = event.text;
  if (event.begins()) open(event.kind == Kind::begin_array);
  if (event.kind == Kind::begin_object && event.announced != unknown_length)
    return to_.begin_object(event.announced + frames_.back().unknown.size());
  if (event.ends()) {
    for (const auto& [name, text] : frames_.back().unknown) {
      to_.key(name);
      read_json(text, to_);
    }
    frames_.pop_back();
  }
  to_.on(event);
  if (!event.begins() && event.kind != Kind::key && !frames_.empty()) ++frames_.back().index;
}

}  // namespace mercury
