// SPDX-License-Identifier: Apache-2.0
#include "robots/importers/encodings.h"

#include <gtest/gtest.h>
#include <zlib.h>

#include <string>

#include "mercury/error.h"
#include "tests/refusal.h"

namespace mercury {
namespace {

std::string compressed(const std::string& bytes) {
  uLongf size = compressBound(bytes.size());
  std::string stream(size, '\0');
  compress2(reinterpret_cast<Bytef*>(stream.data()), &size, reinterpret_cast<const Bytef*>(bytes.data()), bytes.size(),
            9);
  stream.resize(size);
  return stream;
}

TEST(Base64, HasTheVectorsOfRfc4648) {
  const std::pair<const char*, const char*> vectors[] = {{"", ""},
                                                         {"f", "Zg=="},
                                                         {"fo", "Zm8="},
                                                         {"foo", "Zm9v"},
                                                         {"foob", "Zm9vYg=="},
                                                         {"fooba", "Zm9vYmE="},
                                                         {"foobar", "Zm9vYmFy"}};
  for (const auto& [bytes, text] : vectors) {
    EXPECT_EQ(base64_decoded(text), bytes);
    EXPECT_EQ(base64_encoded(bytes), text);
  }
}

TEST(Base64, PassesOverWhiteSpaceAndMissingPadding) {
  EXPECT_EQ(base64_decoded(" Zm9v\nYmE "), "fooba");
  EXPECT_EQ(base64_decoded("Zg"), "f");
}

TEST(Base64, RefusesWhatIsNone) {
  for (const char* text : {"Zg=", "Z", "Zm9v=", "Z!9v", "Zg==Zg==", "====", "Zm9vY==="})
    EXPECT_THROW(base64_decoded(text), InputError) << text;
}

TEST(Zlib, GivesBackWhatWasCompressed) {
  const std::string bytes(49, '\3');
  EXPECT_EQ(inflated(compressed(bytes), 49), bytes);
  EXPECT_EQ(inflated(compressed(""), 0), "");
}

TEST(Zlib, RefusesStreamsOfAnotherLength) {
  const std::string stream = compressed(std::string(49, '\3'));
  EXPECT_THROW(inflated(stream, 48), InputError);
  EXPECT_THROW(inflated(stream, 50), InputError);
}

// 16 MiB of zeros in 16 kB: the reader stops after the first bytes too many.
TEST(Zlib, StopsABomb) {
  const std::string bomb = compressed(std::string(std::size_t{1} << 24, '\0'));
  EXPECT_LT(bomb.size(), std::size_t{1} << 15);
  EXPECT_EQ(refusal([&] { inflated(bomb, 100); }), "the zlib data hold more than 100 bytes");
}

TEST(Zlib, RefusesDamagedAndBrokenStreams) {
  std::string stream = compressed("a layer of voxels");
  EXPECT_THROW(inflated(stream.substr(0, stream.size() - 5), 17), InputError);
  EXPECT_THROW(inflated("", 17), InputError);
  stream[8] = static_cast<char>(stream[8] ^ 0x55);
  EXPECT_THROW(inflated(stream, 17), InputError);
}

}  // namespace
}  // namespace mercury
