// Version 1 of the attribute stream and the COLOR filter of KHR_meshopt_compression. The installed
// library cannot write them, so meshoptimizer 1.3 made the streams below from the values that the
// tests compute.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <meshoptimizer.h>

#include <cstring>

#include "mesh/io/gltf/gltf_uri.h"
#include "mesh/io/gltf/meshopt_stream.h"

namespace {

using namespace strata;
using testing::HasSubstr;
using Bytes = std::vector<std::uint8_t>;

constexpr std::uint64_t kMax = 1 << 20;

Bytes decoded(const std::string& base64) {
  return mesh::decode_data_uri("data:;base64," + base64).value();
}

// Two blocks with all modes of bytes (0 to 8 bits, zeros, literals) and of channels (bytes, shorts,
// exclusive-or words).
const std::string kStream =
    "oZk5GgBqqqqqqgZmZmZmZmZmZmZmZmZmZmZmZmZmZmZmZmZmZmZmZmZmZmZmZmZmZmZmZmZmZmZmZmZmZmZmZmZmZmZmZmZmZmZm"
    "ZmZmZmZmZmZmZmZmZmZmZmZmZmZmZmZmZmZmZmZmZmZmZmZmZmZmZmZmZmZmZmZmZmZmZmZmZmZmZmZmZmZm+v///wACIiRERmZo"
    "iIqqrMzO7u8QEBAQEhISEhQUFBQWFhYWGBgYGBoaGhocHBwcHh4eHiAgICAiIiIiJCQkJCYmJiYoKCgoKioqKiwsLCwuLi4uMDAw"
    "MDIyMjI0NDQ0NjY2Njg4ODg6Ojo6PDw8PD4+Pj5AQEBAQkJCQkRERERGRkZGSEhISEpKSkpMTExMTk5OTlBQUFBSUlJSVFRUVFZW"
    "VlZYWFhYWlpaWlxcXFxeXl5eYGBgYGJiYmJkZGRkZmZmZmhoaGhqampqbGxsbG5ubm5wcHBwcnJycnR0dHR2dnZ2eHh4eHp6enp8"
    "fHx8fn5+foBVVVVVJmZmZmZmZmZmZmZmZmZmZmZmZmZmZmZmZmZmZmZmZmZmZmZmZmZmZmZmZmZmZmZmZmZmZmZmZmZmZmZmZmZm"
    "ZgBKSkpKSkpKSkpKSkpKSkpKSkpKSkpKSkpKSkpKSkpKSkpKSkpKSkpKSkpKSkpKSkpKSkpKSkpKSkpKSkpKSkpKSkpKSkpKSkpK"
    "SkpKSkpKSkpKSkpKSkpKSkpKSkpKSkpKSkpKSkpKSkpKSkpKSkpKSkpKSkpKSkpKSkpKSkpKSkpKSkpKSkpKSkpKSkpKSkpKSkpK"
    "SkpKSkpKSkpKSkpKSkpKSkpKSkpKSkpKSkpKSkpKSkpKSkpKSkpKSkpKSkpKSkpKSkpKSkpKSkpKSkpKSkpKSkpKSkpKSkpKSkpK"
    "SkpKSkpKSkpKSkpKSkpKSkpKSkpKSkpKSkpKSkpKSkoQERERAQACAQACAQACAQACAQACAQACAQACrKpVVfj/gIBAQEBAICAgICAg"
    "ICAQEBAQEBAQEBAQEBAQEBD4iIiIiIiIiBCIiIiIiIiIiIRERERERERERERERERERERERERERERERERERERERERE6qqqqgSqqqqq"
    "qqqqqqqqqqqqqqqqqqqqqqqqqqqqqqqqAQAAAAYAfQEVAAAA/v/euY7JQaZuaZ4GTgmBmS7//1Zexg62wSYR6R55MYn+5lEBAEEV"
    "AAAA/v9Y+HJmqDj78YsfxvNhsW3//8AIHbGKb/onyusF7x2JQNYBAFYVAAAA/P/juvqvgxhT2vAGLhQnKf//lpYinHT2mtnNWVQ7"
    "bCkOPgEAwRUAAAD+/0RGZrCk0G/swcVYVn7Mgf//Pe62S6E5D35f1z9nO/pcfgEAWaqqqqoBMTExMTExMTExMTExMTExMTExMTEx"
    "MTExMTExMTExMTExMTExMTExMTExMTExMTExMTExMTExMTExMTExMTExMTExMTExMTExMTExMTExMTExMTExMTExMTExMTExMTEx"
    "MTExMTExMTExMTExMTExMTExMTExMTExMTExMTExMbk5n6pqKmZmZmZmZmZmZmZmZmZmZmZmZmZmZmYAAICAgIKCgoKEhISEhoaG"
    "hoiIiIiKioqKjIyMjI6Ojo6QkJCQkpKSkpSUlJSWFWZmZmZmZmZmZmZmAEpKSkpKSkpKSkpKSkpKSkpKSkpKSkpKSkpKSkpKSkpK"
    "SkpKSkpKSkpKSkpKEQEAAgEAAgD/////////////////////////////////////////////////////////AP//////////////"
    "//////////////////////////////////////////8ViIiIiIiIiIiIiIgAKjExMTExMTExMTExMTExMTExMTExMTEAAAAAAAAA"
    "BwAAAAAAAGxZiDwAAABAAQABAEI=";
constexpr std::uint64_t kCount = 300, kStride = 20;

Bytes expected_elements() {
  Bytes bytes(kCount * kStride);
  std::uint32_t random = 1;
  for (std::uint32_t i = 0; i < kCount; ++i) {
    std::uint8_t* at = &bytes[i * kStride];
    const auto put = [&](std::size_t offset, auto number) {
      std::memcpy(at + offset, &number, sizeof number);
    };
    put(0, static_cast<std::uint16_t>(i * 3));
    put(2, static_cast<std::uint16_t>(i * i >> 3));
    put(4, static_cast<std::uint8_t>(i & 1));
    put(5, std::uint8_t{7});
    put(6, static_cast<std::uint8_t>(i * 37));
    put(7, static_cast<std::uint8_t>(i >> 5));
    put(8, static_cast<float>(i) * 0.25f);
    random = random * 1664525u + 1013904223u;
    put(12, i < 32 ? random : 0u);
    put(16, 0x40000000u | (i & 3) << 20);
  }
  return bytes;
}

TEST(MeshMeshopt, the_second_version_of_attributes_is_decoded) {
  const auto found =
      mesh::decode_meshopt(decoded(kStream), {"ATTRIBUTES", "", kCount, kStride}, kMax);
  ASSERT_TRUE(found) << found.error();
  EXPECT_EQ(*found, expected_elements());
}

TEST(MeshMeshopt, a_stream_that_is_cut_or_longer_or_of_an_unknown_channel_is_refused) {
  const Bytes whole = decoded(kStream);
  const mesh::MeshoptShape shape{"ATTRIBUTES", "", kCount, kStride};
  for (std::size_t size = 0; size < whole.size(); ++size) {
    // A copy of exactly this size, so the sanitizer detects any read beyond its end.
    const Bytes cut(whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(size));
    EXPECT_FALSE(mesh::decode_meshopt(cut, shape, kMax)) << size;
  }
  Bytes longer = whole;
  longer.insert(longer.begin() + 1, 0);
  EXPECT_FALSE(mesh::decode_meshopt(longer, shape, kMax));
  for (const int mode : {3, 0x10, 0x21, 0x1f}) {
    Bytes wrong = whole;
    wrong.back() = static_cast<std::uint8_t>(mode);
    EXPECT_FALSE(mesh::decode_meshopt(wrong, shape, kMax)) << mode;
  }
}

TEST(MeshMeshopt, colours_are_turned_from_luma_and_chroma) {
  const auto bytes = mesh::decode_meshopt(
      decoded("of8Afn2BAswA/f3+AGUAg4KAAAAAAH1+/cwAAAAAAAAAAAAAAAAAAAAAAAAAQH/B/wA="),
      {"ATTRIBUTES", "COLOR", 6, 4}, kMax);
  ASSERT_TRUE(bytes) << bytes.error();
  EXPECT_EQ(*bytes, (Bytes{254, 1,   0,   255, 0, 254, 0, 255, 1,  0,   255, 128,
                           255, 255, 255, 255, 0, 0,   0, 0,   51, 102, 153, 204}));
  const auto wide = mesh::decode_meshopt(
      decoded("of/9AAECAQLMAAYFFh0MAAICAQBlAA0PEAAHAAYAAwIAFhUIAAAAAAIBAswAAAUGDQwAAAAAAAAA"
              "AAAAAAAAAAAE/wcB/P8PAAA="),
      {"ATTRIBUTES", "COLOR", 6, 8}, kMax);
  ASSERT_TRUE(wide) << wide.error();
  std::vector<std::uint16_t> numbers(24);
  std::memcpy(numbers.data(), wide->data(), 48);
  EXPECT_EQ(numbers,
            (std::vector<std::uint16_t>{65519, 16, 0,     65535, 0,     65519, 0,     65535,
                                        16,    0,  65535, 32776, 65535, 65535, 65535, 65535,
                                        0,     0,  0,     0,     13107, 26214, 39321, 52428}));
}

TEST(MeshMeshopt, what_a_view_says_of_itself_must_fit) {
  const Bytes stream = decoded(kStream);
  const std::vector<std::pair<mesh::MeshoptShape, std::string>> wrong{
      {{"VERTICES", "", 3, 4}, "it has no mode \"VERTICES\""},
      {{"ATTRIBUTES", "", 3, 6}, "elements of 6 bytes are not possible in the mode ATTRIBUTES"},
      {{"ATTRIBUTES", "", 3, 260}, "elements of 260 bytes"},
      {{"ATTRIBUTES", "", 3, 0}, "elements of 0 bytes"},
      {{"INDICES", "", 3, 1}, "elements of 1 bytes are not possible in the mode INDICES"},
      {{"TRIANGLES", "", 4, 2}, "its 4 indices are not a multiple of three"},
      {{"TRIANGLES", "OCTAHEDRAL", 3, 4}, "the filter \"OCTAHEDRAL\" is not possible"},
      {{"ATTRIBUTES", "QUATERNION", 3, 4},
       "the filter \"QUATERNION\" is not possible for elements of 4 bytes"},
      {{"ATTRIBUTES", "COLOR", 3, 12}, "the filter \"COLOR\""},
      {{"ATTRIBUTES", "SEPIA", 3, 4}, "the filter \"SEPIA\""},
      {{"ATTRIBUTES", "", 400'000'000, 4}, "cannot hold 400000000 elements"},
      {{"ATTRIBUTES", "", 60'000, 20}, "it becomes too large"}};
  for (const auto& [shape, says] : wrong) {
    const auto found = mesh::decode_meshopt(stream, shape, kMax);
    ASSERT_FALSE(found) << says;
    EXPECT_THAT(found.error(), HasSubstr(says));
  }
  EXPECT_FALSE(mesh::decode_meshopt({}, {"ATTRIBUTES", "", 3, 4}, kMax));
  EXPECT_TRUE(mesh::decode_meshopt({}, {"ATTRIBUTES", "", 0, 4}, kMax));
}

TEST(MeshMeshopt, every_index_mode_gives_what_was_encoded) {
  const std::vector<unsigned> indices{0, 1, 2, 2, 1, 3, 4, 6, 5, 70'000, 1, 9};
  Bytes sequence(meshopt_encodeIndexSequenceBound(indices.size(), 70'001));
  sequence.resize(meshopt_encodeIndexSequence(sequence.data(), sequence.size(), indices.data(),
                                              indices.size()));
  const auto found = mesh::decode_meshopt(sequence, {"INDICES", "NONE", indices.size(), 4}, kMax);
  ASSERT_TRUE(found) << found.error();
  EXPECT_EQ(std::memcmp(found->data(), indices.data(), found->size()), 0);
}

}  // namespace
