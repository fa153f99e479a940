// SPDX-License-Identifier: Apache-2.0
// A JSON or CBOR document as a stream of events, read and written without holding it as a tree.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "mercury/error.h"

namespace mercury {

// A number of a document: a whole number that fits 64 bits, else a real one.
struct Number {
  enum class Kind { natural, negative, real };
  Kind kind = Kind::natural;
  std::uint64_t natural = 0;  // if natural
  std::int64_t negative = 0;  // if negative, below 0
  double real = 0;            // the value, whatever the kind; infinite where a JSON number is too large for a double
  std::string_view text;      // as it stood in a JSON text, else empty; valid during the event only
};

// The nearest float, read from the number's text where there is one, so that a float's shortest form comes back
// exactly. Nothing if it is not finite as a float; a number too small for a float is 0.
std::optional<float> to_float(const Number& number);

// The number as JSON writes it: its own text, else its shortest form. It must be finite.
std::string to_text(const Number& number);

inline constexpr std::size_t unknown_length = static_cast<std::size_t>(-1);
inline constexpr int max_depth = 64;  // arrays and objects within each other

// What a document holds, one after another. A key is followed by its value.
struct Event {
  enum class Kind { null, boolean, number, text, bytes, key, begin_array, end_array, begin_object, end_object };
  Kind kind = Kind::null;
  bool truth = false;                      // of a boolean
  const Number* number = nullptr;          // of a number
  std::string_view text = {};              // of text (UTF-8 in JSON, unchecked in CBOR), bytes (of CBOR) or a key
  std::size_t announced = unknown_length;  // elements that the document says will follow; they may not be there

  bool begins() const { return kind == Kind::begin_array || kind == Kind::begin_object; }
  bool ends() const { return kind == Kind::end_array || kind == Kind::end_object; }
  int change_of_depth() const { return begins() - ends(); }
};

// "null", "true", "a number", "an array", for messages. Of no key, and of nothing that ends.
std::string_view name_of(const Event& event);

// What receives a document.
class DocumentEvents {
 public:
  virtual ~DocumentEvents() = default;
  using Kind = Event::Kind;

  virtual void on(const Event& event) = 0;

  void null() { on({.kind = Kind::null}); }
  void boolean(bool value) { on({.kind = Kind::boolean, .truth = value}); }
  void number(const Number& value) { on({.kind = Kind::number, .number = &value}); }
  void text(std::string_view value) { on({.kind = Kind::text, .text = value}); }
  void bytes(std::string_view value) { on({.kind = Kind::bytes, .text = value}); }
  void key(std::string_view name) { on({.kind = Kind::key, .text = name}); }
  void begin_array(std::size_t announced) { on({.kind = Kind::begin_array, .announced = announced}); }
  void end_array() { on({.kind = Kind::end_array}); }
  void begin_object(std::size_t announced) { on({.kind = Kind::begin_object, .announced = announced}); }
  void end_object() { on({.kind = Kind::end_object}); }
};

// Sends the whole document's events. Throw InputError ("line 3, column 7: not valid JSON: ...", "byte 17: ...") for a
// document that breaks off, is no such document, is followed by more, or nests deeper than max_depth. Memory follows
// what the document holds, not what it announces; the stack does not grow with its depth. Exceptions of `events` pass
// through.
void read_json(std::string_view document, DocumentEvents& events);
void read_cbor(std::string_view document, DocumentEvents& events);

// Keys and values of an object, as JSON text.
using MemberTexts = std::vector<std::pair<std::string, std::string>>;
// Of the outermost object of a JSON document. Throws as read_json().
MemberTexts members_of(std::string_view document);
// One of them, the last of several with this name; empty if there is none. A parser that builds a tree of the rest, the
// weights of a network say, takes more time and memory, and one that drops what it has built takes time with the square
// of what is there.
std::string json_member(std::string_view document, std::string_view name);

// How deep the arrays and objects of a JSON text lie within each other. The text may be broken.
int json_depth(std::string_view text);

// What nlohmann's parser reports about a JSON document, in our words: "line 3, column 7: not valid JSON: invalid
// literal". `position` [bytes], `id` and `message` are those of its exception.
InputError json_error(std::string_view document, std::size_t position, int id, const std::string& message);

// Where the first of several documents ends that follow each other [bytes]. For CBOR, throws InputError for one that
// breaks off or is none. For JSON, where its brackets are closed; the end of the text if they are not. The document may
// be broken in other ways.
std::size_t first_cbor_item(std::string_view documents);
std::size_t first_json_value(std::string_view documents);

// Writes events as JSON text without spaces. Throws InputError for text that is not UTF-8, numbers that are not
// finite, and bytes, which JSON lacks.
class JsonWriter : public DocumentEvents {
 public:
  // rows: each key of the outermost object on a line of its own, its lists broken into lines of about 100 characters
  enum class Layout { compact, rows };
  explicit JsonWriter(std::string& out, Layout layout = Layout::compact) : out_(out), layout_(layout) {}
  void on(const Event& event) override;

 private:
  void separate(bool is_key);

  std::string& out_;
  Layout layout_;
  int depth_ = 0;
  bool first_ = true;  // no element yet in the array or object that is open
  bool after_key_ = false;
  std::size_t line_ = 0;  // where the current line begins in out_
};

// Writes events as CBOR (RFC 8949): floats where they hold the number exactly, else doubles.
class CborWriter : public DocumentEvents {
 public:
  explicit CborWriter(std::string& out) : out_(out) {}
  void on(const Event& event) override;

 private:
  void big_endian(std::uint64_t value, int bytes);
  void head(unsigned major_type, std::uint64_t value);
  void number_of(const Number& value);

  std::string& out_;
  std::uint64_t open_ended_ = 0;  // a bit for each open array or object, set where its length was not announced
};

// Numbers for the writers.
Number natural_number(std::uint64_t value);
Number real_number(float value, std::span<char> room);  // `room` keeps its text, at least 32 characters

// A JSON string with its quotes. Throws InputError for text that is not UTF-8.
std::string json_text(std::string_view text);

}  // namespace mercury
