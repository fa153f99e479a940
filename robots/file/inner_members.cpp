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

// Collects the members of an object.
class Split : public DocumentEvents {
 public:
  void null() override {
    value([&](DocumentEvents& to) { to.null(); });
  }
  void boolean(bool of) override {
    value([&](DocumentEvents& to) { to.boolean(of); });
  }
  void number(const Number& of) override {
    value([&](DocumentEvents& to) { to.number(of); });
  }
  void text(std::string_view of) override {
    value([&](DocumentEvents& to) { to.text(of); });
  }
  void bytes(std::string_view of) override {
    value([&](DocumentEvents& to) { to.bytes(of); });
  }
  void begin_array(std::size_t announced) override {
    if (depth_++ > 0) writer_->begin_array(announced);
  }
  void end_array() override {
    if (--depth_ > 0) value([&](DocumentEvents& to) { to.end_array(); });
  }
  void begin_object(std::size_t announced) override {
    if (depth_++ > 0) writer_->begin_object(announced);
  }
  void end_object() override {
    if (--depth_ > 0) value([&](DocumentEvents& to) { to.end_object(); });
  }
  void key(std::string_view name) override {
    if (depth_ > 1) return writer_->key(name);
    key_ = name;
    text_.clear();
    writer_.emplace(text_);
  }

  MemberTexts take() { return std::move(members_); }

 private:
  template <class Write>
  void value(const Write& write) {
    write(*writer_);
    if (depth_ == 1) members_.emplace_back(key_, text_);
  }

  MemberTexts members_;
  std::string key_, text_;
  std::optional<JsonWriter> writer_;
  int depth_ = 0;
};

}  // namespace

MemberTexts members_of(std::string_view object) {
  if (object.empty()) return {};
  Split split;
  read_json(object, split);
  return split.take();
}

MemberTexts members_of_document(std::string_view other) {
  MemberTexts members = members_of(other);
  std::erase_if(members, [](const auto& member) { return document_place().knows(member.first); });
  return members;
}

// --- Reading

template <class Send, class Take>
void InnerMembersReader::value(const Send& send, const Take& take) {
  if (taken_depth_ < 0) {
    send();
    if (beyond_ == 0 && !frames_.empty()) ++frames_.back().index;
    return;
  }
  take();
  if (taken_depth_ == 0) end_taken();
}

void InnerMembersReader::null() {
  value([&] { to_.null(); }, [&] { taken_.null(); });
}
void InnerMembersReader::boolean(bool of) {
  value([&] { to_.boolean(of); }, [&] { taken_.boolean(of); });
}
void InnerMembersReader::number(const Number& of) {
  value([&] { to_.number(of); }, [&] { taken_.number(of); });
}
void InnerMembersReader::text(std::string_view of) {
  value([&] { to_.text(of); }, [&] { taken_.text(of); });
}
void InnerMembersReader::bytes(std::string_view of) {
  value([&] { to_.bytes(of); }, [&] { taken_.bytes(of); });
}

void InnerMembersReader::open(bool is_array) {
  const ObjectPlace* const place = beyond_ > 0 ? nullptr : place_of_next(frames_, is_array);
  if (place)
    frames_.push_back({.place = place, .is_array = is_array, .index = 0, .key = {}, .members = {}, .inner = {}});
  else
    ++beyond_;
}
void InnerMembersReader::begin_array(std::size_t announced) {
  if (taken_depth_ >= 0) return ++taken_depth_, taken_.begin_array(announced);
  open(true);
  to_.begin_array(announced);
}
void InnerMembersReader::begin_object(std::size_t announced) {
  if (taken_depth_ >= 0) return ++taken_depth_, taken_.begin_object(announced);
  open(false);
  to_.begin_object(announced);
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
void InnerMembersReader::end_array() {
  if (taken_depth_ < 0) return close(), to_.end_array();
  taken_.end_array();
  if (--taken_depth_ == 0) end_taken();
}
void InnerMembersReader::end_object() {
  if (taken_depth_ < 0) return close(), to_.end_object();
  taken_.end_object();
  if (--taken_depth_ == 0) end_taken();
}

void InnerMembersReader::key(std::string_view name) {
  if (taken_depth_ >= 0) return taken_.key(name);
  if (beyond_ > 0) return to_.key(name);
  Frame& object = frames_.back();
  if (frames_.size() > 1 && !object.place->knows(name)) {
    taken_depth_ = 0;
    return taken_.begin_member(name);
  }
  object.key = name;
  to_.key(name);
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

void InnerMembersWriter::value_ended() {
  if (!frames_.empty()) ++frames_.back().index;
}
void InnerMembersWriter::null() { to_.null(), value_ended(); }
void InnerMembersWriter::boolean(bool value) { to_.boolean(value), value_ended(); }
void InnerMembersWriter::number(const Number& value) { to_.number(value), value_ended(); }
void InnerMembersWriter::text(std::string_view value) { to_.text(value), value_ended(); }
void InnerMembersWriter::bytes(std::string_view value) { to_.bytes(value), value_ended(); }

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
void InnerMembersWriter::close() {
  frames_.pop_back();
  value_ended();
}
void InnerMembersWriter::begin_array(std::size_t announced) {
  open(true);
  to_.begin_array(announced);
}
void InnerMembersWriter::end_array() { close(), to_.end_array(); }
void InnerMembersWriter::begin_object(std::size_t announced) {
  open(false);
  to_.begin_object(announced == unknown_length ? announced : announced + frames_.back().unknown.size());
}
void InnerMembersWriter::end_object() {
  for (const auto& [name, text] : frames_.back().unknown) {
    to_.key(name);
    read_json(text, to_);
  }
  close(), to_.end_object();
}
void InnerMembersWriter::key(std::string_view name) {
  frames_.back().key = name;
  to_.key(name);
}

}  // namespace mercury
