// Content encodings: those that clients may request, and the decoding of each encoded response to
// the original.
#include "net/http/compression.h"

#include <brotli/decode.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <zlib.h>

#include <string>
#include <vector>

namespace strata::net {
namespace {

std::string decoded(const std::vector<std::uint8_t>& bytes, std::string_view coding) {
  std::string text(4 << 20, 0);
  if (coding == "br") {
    std::size_t size = text.size();
    EXPECT_EQ(BrotliDecoderDecompress(bytes.size(), bytes.data(), &size,
                                      reinterpret_cast<std::uint8_t*>(text.data())),
              BROTLI_DECODER_RESULT_SUCCESS);
    text.resize(size);
    return text;
  }
  z_stream stream{};
  EXPECT_EQ(inflateInit2(&stream, 15 + 16), Z_OK);
  stream.next_in = const_cast<Bytef*>(bytes.data());
  stream.avail_in = static_cast<uInt>(bytes.size());
  stream.next_out = reinterpret_cast<Bytef*>(text.data());
  stream.avail_out = static_cast<uInt>(text.size());
  EXPECT_EQ(inflate(&stream, Z_FINISH), Z_STREAM_END);
  text.resize(text.size() - stream.avail_out);
  inflateEnd(&stream);
  return text;
}

std::string table_of(int rows) {
  std::string text = "key,name\r\n";
  for (int i = 0; i < rows; ++i)
    text += std::to_string(i * 7919 % 1000) + ",record " + std::to_string(i) + "\r\n";
  return text;
}

std::string coding_of(std::string_view accept) {
  const auto coding = accepted_coding(accept);
  return coding ? std::string(name(*coding)) : "none";
}

TEST(Compression, takes_the_best_coding_that_the_client_takes) {
  EXPECT_EQ(coding_of("gzip, deflate, br, zstd"), "br");
  EXPECT_EQ(coding_of("gzip"), "gzip");
  EXPECT_EQ(coding_of("GZIP"), "gzip");
  EXPECT_EQ(coding_of("br;q=0.5, gzip;q=0.8"), "gzip");
  EXPECT_EQ(coding_of("br ; q=1.0 , gzip;q=0.8"), "br");
  EXPECT_EQ(coding_of("*"), "br");
  EXPECT_EQ(coding_of("*;q=0.1, br;q=0"), "gzip");
  for (const char* none : {"", "identity", "deflate", "br;q=0, gzip;q=0", "*;q=0",
                           "gzip;q=", "gzip;q=x", ";;;,,,", "gzipx"})
    EXPECT_EQ(coding_of(none), "none") << none;
}

TEST(Compression, a_text_leaves_in_the_coding_and_decodes_to_itself) {
  for (const int rows : {100, 20'000})
    for (const char* coding : {"gzip", "br"}) {
      Response response = text_response(table_of(rows), "text/csv; charset=utf-8");
      response.with("ETag", "\"v3\"");
      compress(response, coding);
      EXPECT_EQ(response.header("Content-Encoding"), coding);
      EXPECT_EQ(response.header("Vary"), "Accept-Encoding");
      EXPECT_EQ(response.header("ETag"), "\"v3-" + std::string(coding) + "\"");
      EXPECT_TRUE(response.body.empty());
      EXPECT_LT(response.bytes.size() * 3, table_of(rows).size());
      EXPECT_EQ(decoded(response.bytes, coding), table_of(rows));
    }
}

TEST(Compression, a_stream_is_coded_piece_by_piece_and_loses_its_length) {
  for (const char* coding : {"gzip", "br"}) {
    const std::string text = table_of(30'000);
    Response response = text_response({}, "text/csv");
    response.stream = Response::Stream{
        text.size(), [&](const Response::Sink& sink) {
          for (std::size_t at = 0; at < text.size(); at += 777) {
            const auto piece = std::string_view(text).substr(at, 777);
            if (!sink({reinterpret_cast<const std::uint8_t*>(piece.data()), piece.size()}))
              return false;
          }
          return true;
        }};
    compress(response, coding);
    ASSERT_TRUE(response.stream);
    EXPECT_FALSE(response.stream->length);
    std::vector<std::uint8_t> sent;
    EXPECT_TRUE(response.stream->write([&](std::span<const std::uint8_t> bytes) {
      sent.insert(sent.end(), bytes.begin(), bytes.end());
      return true;
    }));
    EXPECT_EQ(decoded(sent, coding), text);
    EXPECT_FALSE(response.stream->write([](std::span<const std::uint8_t>) { return false; }))
        << "the client is gone";
  }
}

TEST(Compression, what_is_small_or_no_text_or_partial_or_secret_stays_as_it_is) {
  const auto untouched = [](Response response) {
    const Response before = response;
    compress(response, "br, gzip");
    return response.header("Content-Encoding") == before.header("Content-Encoding") &&
           response.body == before.body && response.bytes == before.bytes;
  };
  EXPECT_TRUE(untouched(text_response("{}", "application/json")));
  EXPECT_TRUE(untouched(bytes_response(std::vector<std::uint8_t>(5000, 7), "image/png")));
  EXPECT_TRUE(
      untouched(bytes_response(std::vector<std::uint8_t>(5000, 7), "application/octet-stream")));
  EXPECT_TRUE(untouched(text_response(table_of(500), "text/csv").with("Accept-Ranges", "bytes")));
  EXPECT_TRUE(
      untouched(text_response(table_of(500), "text/csv").with("Content-Range", "bytes 0-9/10")));
  EXPECT_TRUE(untouched(text_response(table_of(500), "text/csv").with("Content-Encoding", "gzip")));
  EXPECT_TRUE(untouched(
      text_response(table_of(500), "application/json").with("Cache-Control", "no-store")));
  EXPECT_TRUE(untouched(empty_response(304)));
}

TEST(Compression, without_a_coding_the_answer_still_says_that_it_varies) {
  Response response = text_response(table_of(500), "application/geo+json");
  compress(response, "identity");
  EXPECT_EQ(response.header("Vary"), "Accept-Encoding");
  EXPECT_EQ(response.body, table_of(500));
}

TEST(Compression, an_etag_comes_back_without_its_coding) {
  Request request;
  request.headers = {{"if-none-match", "\"v3-br\", \"v4-gzip\", W/\"v5-br\", \"v6\""},
                     {"if-match", "\"v7-gzip\""},
                     {"accept", "\"x-br\""}};
  forget_codings(request);
  EXPECT_EQ(request.header("if-none-match"), "\"v3\", \"v4\", W/\"v5\", \"v6\"");
  EXPECT_EQ(request.header("if-match"), "\"v7\"");
  EXPECT_EQ(request.header("accept"), "\"x-br\"");
}

}  // namespace
}  // namespace strata::net
