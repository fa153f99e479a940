// SPDX-License-Identifier: Apache-2.0
// CBOR (RFC 8949), read without recursion: a hostile file can nest deeper than the stack reaches.
#include <bit>
#include <cmath>
#include <limits>
#include <vector>

#include "mercury/error.h"
#include "robots/file/document.h"

namespace mercury {
namespace {

enum class Major : unsigned { natural, negative, byte_string, text_string, array, map, tag, other };

constexpr unsigned open_ended = 31;  // in the low bits of a head: the length is unknown
constexpr unsigned char stop = 0xff;

double half_to_double(std::uint64_t bits) {
  const double sign = (bits & 0x8000) != 0 ? -1 : 1;
  const auto exponent = static_cast<int>(bits >> 10 & 31);
  const auto mantissa = static_cast<double>(bits & 1023);
  if (exponent == 0) return sign * std::ldexp(mantissa, -24);
  if (exponent == 31) return mantissa == 0 ? sign * HUGE_VAL : std::numeric_limits<double>::quiet_NaN();
  return sign * std::ldexp(mantissa + 1024, exponent - 25);
}

class Reader {
 public:
  Reader(std::string_view document, DocumentEvents& events) : document_(document), events_(events) {}

  // Reads one item; returns where it ends.
  std::size_t run() {
    read_item();
    while (!open_.empty()) {
      Container& container = open_.back();
      if (ends(container)) {
        const bool is_map = container.is_map;
        open_.pop_back();
        is_map ? events_.end_object() : events_.end_array();
        continue;
      }
      if (container.remaining != unknown_length) --container.remaining;
      if (container.is_map) read_key();
      read_item();
    }
    return at_;
  }

 private:
  struct Container {
    bool is_map = false;
    std::size_t remaining = 0;  // elements, or pairs of a map; unknown_length = until a stop
  };
  struct Head {
    std::size_t place = 0;
    Major major = Major::natural;
    unsigned low = 0;
    std::uint64_t value = 0;
  };

  [[noreturn]] static void fail(std::size_t place, const std::string& what) {
    throw InputError("byte " + std::to_string(place), what);
  }

  unsigned char next_byte() {
    if (at_ == document_.size()) fail(at_, "the CBOR document breaks off");
    return static_cast<unsigned char>(document_[at_++]);
  }

  Head read_head() {
    Head head{.place = at_};
    const unsigned first = next_byte();
    head.major = static_cast<Major>(first >> 5);
    head.low = first & 31;
    head.value = head.low;
    if (head.low >= 24 && head.low <= 27) {
      head.value = 0;
      for (int i = 0; i < 1 << (head.low - 24); ++i) head.value = head.value << 8 | next_byte();
    } else if (head.low > 27 && head.low < open_ended) {
      fail(head.place, "not valid CBOR");
    }
    return head;
  }

  bool ends(const Container& container) {
    if (container.remaining != unknown_length) return container.remaining == 0;
    if (at_ == document_.size() || static_cast<unsigned char>(document_[at_]) != stop) return false;
    ++at_;
    return true;
  }

  std::string_view take(std::size_t place, std::uint64_t size) {
    if (size > document_.size() - at_) fail(place, "the CBOR document breaks off");
    const std::string_view taken = document_.substr(at_, static_cast<std::size_t>(size));
    at_ += taken.size();
    return taken;
  }

  // Valid until the next string is read.
  std::string_view read_string(const Head& head) {
    if (head.low != open_ended) return take(head.place, head.value);
    joined_.clear();
    while (at_ == document_.size() || static_cast<unsigned char>(document_[at_]) != stop) {
      const Head piece = read_head();
      if (piece.major != head.major || piece.low == open_ended) fail(piece.place, "not valid CBOR");
      joined_ += take(piece.place, piece.value);
    }
    ++at_;
    return joined_;
  }

  void read_key() {
    const Head head = read_head();
    if (head.major != Major::text_string) fail(head.place, "a key must be text");
    events_.key(read_string(head));
  }

  void read_item() {
    Head head = read_head();
    while (head.major == Major::tag && head.low != open_ended) head = read_head();
    const bool may_be_open_ended = head.major >= Major::byte_string && head.major <= Major::map;
    if (head.low == open_ended && !may_be_open_ended) fail(head.place, "not valid CBOR");
    switch (head.major) {
      case Major::natural:
        return events_.number(natural_number(head.value));
      case Major::negative:
        return read_negative(head);
      case Major::byte_string:
        return events_.bytes(read_string(head));
      case Major::text_string:
        return events_.text(read_string(head));
      case Major::array:
      case Major::map:
        return open(head);
      default:
        return read_other(head);
    }
  }

  void read_negative(const Head& head) {
    Number number{.kind = Number::Kind::negative, .real = -1 - static_cast<double>(head.value)};
    if (head.value > static_cast<std::uint64_t>(std::numeric_limits<std::int64_t>::max()))
      number.kind = Number::Kind::real;
    else
      number.negative = -1 - static_cast<std::int64_t>(head.value);
    events_.number(number);
  }

  void open(const Head& head) {
    if (open_.size() == max_depth) fail(head.place, "nested deeper than " + std::to_string(max_depth) + " levels");
    Container container{.is_map = head.major == Major::map, .remaining = unknown_length};
    if (head.low != open_ended) {
      // Each element takes at least a byte, so a document cannot announce more elements than it has bytes left. The
      // receiver sees the number before it is refused here, because it knows the place and the limit.
      container.remaining = static_cast<std::size_t>(head.value);
      container.is_map ? events_.begin_object(container.remaining) : events_.begin_array(container.remaining);
      if (head.value > document_.size() - at_) fail(head.place, "the CBOR document breaks off");
    } else {
      container.is_map ? events_.begin_object(unknown_length) : events_.begin_array(unknown_length);
    }
    open_.push_back(container);
  }

  void read_other(const Head& head) {
    Number number{.kind = Number::Kind::real};
    switch (head.low) {
      case 20:
      case 21:
        return events_.boolean(head.low == 21);
      case 22:
      case 23:
        return events_.null();  // 23 is "undefined"
      case 25:
        number.real = half_to_double(head.value);
        break;
      case 26:
        number.real = static_cast<double>(std::bit_cast<float>(static_cast<std::uint32_t>(head.value)));
        break;
      case 27:
        number.real = std::bit_cast<double>(head.value);
        break;
      default:
        fail(head.place, "not valid CBOR");
    }
    events_.number(number);
  }

  std::string_view document_;
  DocumentEvents& events_;
  std::size_t at_ = 0;
  std::vector<Container> open_;
  std::string joined_;
};

}  // namespace

void read_cbor(std::string_view document, DocumentEvents& events) {
  if (const std::size_t end = Reader(document, events).run(); end != document.size())
    throw InputError("byte " + std::to_string(end), "more follows the end of the document");
}

std::size_t first_cbor_item(std::string_view documents) {
  struct Nothing final : DocumentEvents {
    void on(const Event&) override {}
  } nothing;
  return Reader(documents, nothing).run();
}

}  // namespace mercury
