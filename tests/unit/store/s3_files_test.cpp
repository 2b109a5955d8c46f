#include "store/files/s3_files.h"

#include <gtest/gtest.h>

namespace strata::store {
namespace {

const S3Environment kKeys{"key", "secret", "", "", "", ""};

std::string url_of(const std::string& place, const std::string& endpoint = {},
                   S3Environment environment = kKeys) {
  const auto there = s3_place({place, endpoint}, environment);
  return there ? there->bucket.url + " " + there->prefix : "refused: " + there.error().field;
}

TEST(S3Place, a_bucket_is_at_amazon_or_at_an_endpoint) {
  EXPECT_EQ(url_of("s3://museum"), "https://museum.s3.us-east-1.amazonaws.com ");
  S3Environment environment = kKeys;
  environment.region = "eu-central-1";
  EXPECT_EQ(url_of("s3://museum/strata/files/", {}, environment),
            "https://museum.s3.eu-central-1.amazonaws.com strata/files/");
  EXPECT_EQ(url_of("s3://mu.seum/a", {}, environment),
            "https://s3.eu-central-1.amazonaws.com/mu.seum a/");
  EXPECT_EQ(url_of("s3://museum/a", "https://s3.example:9000/"),
            "https://s3.example:9000/museum a/");
  environment.endpoint = "http://127.0.0.1:9000";
  EXPECT_EQ(url_of("s3://museum", {}, environment), "http://127.0.0.1:9000/museum ");
  EXPECT_EQ(url_of("s3://museum", "http://[::1]:9000"), "http://[::1]:9000/museum ");
}

TEST(S3Place, other_places_are_refused) {
  for (const char* place :
       {"s3:museum", "s3://", "s3://ab", "s3://mu seum", "s3://museum/a b", "s3://museum//a",
        "s3://museum/a//b", "s3://museum/../a", "s3://museum/a/..", "s3://museum/./a",
        "s3://museum/a?b", "s3://mu@seum"})
    EXPECT_EQ(url_of(place), "refused: --files") << place;
  for (const char* endpoint :
       {"s3.example", "ftp://s3.example", "http://s3.example", "http://127.0.0.1.example",
        "https://", "https://a@b", "https://s3.example/path", "https://s3.example?a"})
    EXPECT_EQ(url_of("s3://museum", endpoint), "refused: --files-endpoint") << endpoint;
  EXPECT_EQ(url_of("s3://museum", {}, {}), "refused: --files") << "no keys";
  S3Environment environment = kKeys;
  environment.region = "eu/../";
  EXPECT_EQ(url_of("s3://museum", {}, environment), "refused: --files");
}

std::string entry(const std::string& key, const std::string& size = "12") {
  return "<Contents><Key>" + key +
         "</Key><LastModified>2026-11-21T14:32:00.000Z</LastModified><ETag>&quot;a&quot;</ETag><Size>" +
         size + "</Size></Contents>";
}

std::string page(const std::string& entries, const std::string& truncated = "false") {
  return "<?xml version='1.0' encoding='UTF-8'?><ListBucketResult "
         "xmlns=\"http://s3.amazonaws.com/doc/2006-03-01/\"><IsTruncated>" +
         truncated + "</IsTruncated>" + entries + "</ListBucketResult>";
}

TEST(S3Page, only_names_of_contents_are_files) {
  const std::string name = file_name_of(Sha256{0xab, 0xcd});
  const auto read = read_s3_page(
      page(entry("p/" + name) + entry("p/ab/cd/short") + entry("p/strata-files.json"), "true"),
      "p/");
  ASSERT_TRUE(read);
  ASSERT_EQ(read->files.size(), 1u);
  EXPECT_EQ(file_name_of(read->files[0].hash), name);
  EXPECT_EQ(read->files[0].bytes, 12u);
  EXPECT_FALSE(read->is_last);
  EXPECT_EQ(read->last_key, "p/strata-files.json");
  EXPECT_TRUE(read_s3_page(page(""), "p/")->is_last);
}

TEST(S3Page, a_damaged_page_is_refused) {
  const std::string name = "p/" + file_name_of(Sha256{1});
  for (const std::string& xml :
       {std::string(), std::string("<html></html>"), page("", "true"),
        page("<Contents></Contents>"), page(entry(name, "-1")), page(entry(name, "")),
        page(entry(name, "12345678901234567890")), page(entry("q/" + name))})
    EXPECT_FALSE(read_s3_page(xml, "p/")) << xml;
  const std::string whole = page(entry(name) + entry(name));
  EXPECT_EQ(read_s3_page(whole, "p/")->files.size(), 2u);
  for (std::size_t size = 0; size < whole.size(); ++size)
    EXPECT_FALSE(read_s3_page(std::string_view(whole).substr(0, size), "p/")) << size;
}

TEST(FileNames, a_name_is_the_hash_and_two_folders_of_it) {
  const Sha256 hash = sha256(std::string_view("content"));
  const std::string name = file_name_of(hash);
  EXPECT_EQ(name.size(), 70u);
  EXPECT_EQ(hash_of_file_name(name), hash);
  std::string upper = name;
  upper.back() = 'F';
  for (const std::string& other : {std::string(), name.substr(1), name + "0",
                                   "00/00/" + name.substr(6), "x" + name.substr(1), upper})
    EXPECT_FALSE(hash_of_file_name(other)) << other;
}

}  // namespace
}  // namespace strata::store
