// SPDX-License-Identifier: Apache-2.0
#include <nlohmann/json.hpp>

#include <algorithm>
#include <limits>
#include <optional>
#include <utility>

#include "mercury/error.h"
#include "robots/file/document.h"

namespace mercury {
namespace {

using Json = nlohmann::json;

constexpr int number_overflow = 406;  // of nlohmann's exceptions

// "line 3, column 7" of the last of the first `bytes` bytes.
std::string place_of(std::string_view document, std::size_t bytes) {
  const std::string_view before = document.substr(0, std::min(bytes, document.size()));
  const auto lines = std::count(before.begin(), before.end(), '\n');
  const std::size_t line_start = lines == 0 ? 0 : before.rfind('\n') + 1;
  return "line " + std::to_string(lines + 1) + ", column " + std::to_string(before.size() - line_start);
}

// "[json.exception.parse_error.101] parse error at line 1, column 5: syntax error while parsing value - invalid
// literal; last read: 'xyz'; expected ']'" becomes "invalid literal".
std::string reason_of(const std::string& message) {
  std::size_t begin = message.find(" - ");
  begin = begin == std::string::npos ? message.find(": ") + 2 : begin + 3;
  std::string reason = message.substr(begin, message.find(';', begin) - begin);
  std::replace_if(
      reason.begin(), reason.end(), [](char c) { return c >= 0 && c < ' '; }, ' ');
  // Newer versions have words of their own for an empty document.
  return reason == "attempting to parse an empty input" ? "unexpected end of input" : reason;
}

// Passes nlohmann's events on, and limits the depth, which its parser does not.
class Adapter : public nlohmann::json_sax<Json> {
 public:
  Adapter(std::string_view document, DocumentEvents& events) : document_(document), events_(events) {}

  bool null() override { return events_.null(), true; }
  bool boolean(bool value) override { return events_.boolean(value), true; }
  bool number_integer(number_integer_t value) override {
    if (value >= 0) return number_unsigned(static_cast<number_unsigned_t>(value));  // "-0"
    events_.number({.kind = Number::Kind::negative, .negative = value, .real = static_cast<double>(value)});
    return true;
  }
  bool number_unsigned(number_unsigned_t value) override { return events_.number(natural_number(value)), true; }
  bool number_float(number_float_t value, const string_t& text) override {
    return events_.number({.kind = Number::Kind::real, .real = value, .text = text}), true;
  }
  bool string(string_t& value) override { return events_.text(value), true; }
  bool binary(binary_t&) override { return false; }  // JSON has none
  bool start_object(std::size_t) override { return deeper(), events_.begin_object(unknown_length), true; }
  bool key(string_t& name) override { return events_.key(name), true; }
  bool end_object() override { return --depth_, events_.end_object(), true; }
  bool start_array(std::size_t) override { return deeper(), events_.begin_array(unknown_length), true; }
  bool end_array() override { return --depth_, events_.end_array(), true; }

  bool parse_error(std::size_t position, const std::string& token, const Json::exception& error) override {
    // A number beyond the doubles ends the parse. The receiver knows its place in the document, and throws.
    if (error.id == number_overflow)
      events_.number({.kind = Number::Kind::real, .real = std::numeric_limits<double>::infinity(), .text = token});
    throw json_error(document_, position, error.id, error.what());
  }

 private:
  void deeper() {
    if (++depth_ > max_depth) throw InputError("nested deeper than " + std::to_string(max_depth) + " levels");
  }

  std::string_view document_;
  DocumentEvents& events_;
  int depth_ = 0;
};

// Collects the members of the outermost object, all or those of one name.
class MemberReader : public DocumentEvents {
 public:
  explicit MemberReader(std::optional<std::string_view> name = std::nullopt) : name_(name) {}
  MemberTexts take() { return std::move(members_); }

  void on(const Event& event) override {
    if (event.kind == Kind::key && depth_ == 1) {
      key_ = event.text;
      text_.clear();
      writer_.reset();
      if (!name_ || *name_ == key_) writer_.emplace(text_);
      return;
    }
    const int before = std::exchange(depth_, depth_ + event.change_of_depth());
    if (!writer_ || std::min(before, depth_) == 0) return;
    writer_->on(event);
    if (depth_ == 1) members_.emplace_back(key_, text_);
  }

 private:
  std::optional<std::string_view> name_;
  MemberTexts members_;
  std::string key_, text_;
  std::optional<JsonWriter> writer_;  // of a member that is wanted
  int depth_ = 0;
};

}  // namespace

InputError json_error(std::string_view document, std::size_t position, int id, const std::string& message) {
  return {place_of(document, position),
          id == number_overflow ? "a number is too large" : "not valid JSON: " + reason_of(message)};
}

void read_json(std::string_view document, DocumentEvents& events) {
  // The parser takes a NUL as the end and would ignore what follows.
  const std::size_t nul = document.find('\0');
  if (nul != std::string_view::npos) throw InputError(place_of(document, nul + 1), "not valid JSON: a NUL byte");
  Adapter adapter(document, events);
  Json::sax_parse(document, &adapter);
}

MemberTexts members_of(std::string_view document) {
  MemberReader reader;
  read_json(document, reader);
  return reader.take();
}

std::string json_member(std::string_view document, std::string_view name) {
  MemberReader reader(name);
  read_json(document, reader);
  MemberTexts found = reader.take();
  return found.empty() ? "" : std::move(found.back().second);
}

int json_depth(std::string_view text) {
  int depth = 0, deepest = 0;
  bool in_text = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char letter = text[i];
    if (letter == '"') in_text = !in_text;
    if (in_text && letter == '\\') ++i;
    if (in_text) continue;
    if (letter == '{' || letter == '[') deepest = std::max(deepest, ++depth);
    if (letter == '}' || letter == ']') --depth;
  }
  return deepest;
}

std::size_t first_json_value(std::string_view documents) {
  std::size_t depth = 0;
  bool in_text = false;
  for (std::size_t i = 0; i < documents.size(); ++i) {
    const char letter = documents[i];
    if (in_text) {
      if (letter == '\\') ++i;
      in_text = letter != '"';
    } else if (letter == '"') {
      in_text = true;
    } else if (letter == '{' || letter == '[') {
      ++depth;
    } else if ((letter == '}' || letter == ']') && (depth == 0 || --depth == 0)) {
      return i + 1;
    }
  }
  return documents.size();
}

std::string json_text(std::string_view text) {
  try {
    return Json(text).dump();
  } catch (const Json::type_error&) {
    throw InputError("a text is not valid UTF-8");
  }
}

}  // namespace mercury
