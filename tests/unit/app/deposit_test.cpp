// Identifiers, names of files and metadata of deposits.
#include <gtest/gtest.h>

#include "app/deposit/bag.h"
#include "app/deposit/citation.h"
#include "app/deposit/datacite.h"
#include "app/deposit/identifiers.h"
#include "app/deposit/metadata.h"
#include "core/unzip.h"

namespace strata::app {
namespace {

// The examples of the registries themselves.
TEST(Identifiers, an_orcid_has_a_check_digit) {
  for (const char* good : {"0000-0002-1825-0097", "https://orcid.org/0000-0001-5109-3700",
                           "0000-0002-1694-233X", "0000-0002-1694-233x"})
    EXPECT_TRUE(orcid_uri(good)) << good;
  EXPECT_EQ(orcid_uri("0000-0002-1694-233x"), "https://orcid.org/0000-0002-1694-233X");
  for (const char* bad : {"0000-0002-1825-0098", "0000-0002-1694-2330", "0000000218250097", "",
                          "0000-0002-1825-00977", "https://example.org/0000-0002-1825-0097"})
    EXPECT_FALSE(orcid_uri(bad)) << bad;
}

TEST(Identifiers, each_wrong_digit_of_an_orcid_is_found) {
  const std::string good = "0000-0002-1825-0097";
  for (std::size_t i = 0; i < good.size(); ++i)
    for (char digit = '0'; digit <= '9'; ++digit) {
      std::string changed = good;
      changed[i] = digit;
      EXPECT_EQ(orcid_uri(changed).has_value(), changed == good) << changed;
    }
}

TEST(Identifiers, a_ror_has_check_digits) {
  for (const char* good : {"04wxnsj81", "https://ror.org/05dxps055", "02MHBDP94", "00k4n6c32"})
    EXPECT_TRUE(ror_uri(good)) << good;
  EXPECT_EQ(ror_uri("02MHBDP94"), "https://ror.org/02mhbdp94");
  for (const char* bad : {"04wxnsj82", "14wxnsj81", "04wxnsi81", "04wxnsj8", ""})
    EXPECT_FALSE(ror_uri(bad)) << bad;
}

TEST(Identifiers, a_doi_has_no_address) {
  EXPECT_EQ(doi_of("https://doi.org/10.5281/zenodo.1"), "10.5281/zenodo.1");
  EXPECT_EQ(doi_of("doi:10.1000/182"), "10.1000/182");
  for (const char* bad : {"10.1/x", "10.5281/", "11.5281/x", "10.5281/a b", "10.52a1/x", ""})
    EXPECT_FALSE(doi_of(bad)) << bad;
}

TEST(Identifiers, a_license_is_found_by_identifier_and_address) {
  EXPECT_EQ(find_license("cc-by-4.0")->id, "CC-BY-4.0");
  EXPECT_EQ(find_license("http://creativecommons.org/licenses/by/4.0")->id, "CC-BY-4.0");
  EXPECT_EQ(find_license("https://rightsstatements.org/vocab/InC/1.0/")->id, "InC");
  EXPECT_FALSE(find_license("CC-BY"));
  EXPECT_TRUE(is_license("https://example.org/our-license"));
  EXPECT_FALSE(is_license("http://rightsstatements.org/vocab/Nothing/1.0/"));
  EXPECT_FALSE(is_license("free"));
}

TEST(Bags, names_of_files_are_portable) {
  EXPECT_EQ(portable_name("a:b?.jpg", "file"), "a_b_.jpg");
  EXPECT_EQ(portable_name("../../x", "file"), "x");
  EXPECT_EQ(portable_name("..", "file"), "file");
  EXPECT_EQ(portable_name("", "file"), "file");
  EXPECT_EQ(portable_name(".hidden", "file"), "file.hidden");
  EXPECT_EQ(portable_name("ends. ", "file"), "ends");
}

TEST(Bags, a_path_is_used_only_once_in_any_case) {
  Bag bag("", {});
  EXPECT_EQ(bag.free_path("a/x.tif"), "a/x.tif");
  BagFile file;
  file.path = "a/X.tif";
  bag.add_stored(file);
  EXPECT_EQ(bag.free_path("a/x.tif"), "a/x-2.tif");
  file.path = "a.b/x";
  bag.add_stored(file);
  EXPECT_EQ(bag.free_path("a.b/x"), "a.b/x-2");
}

TEST(Bags, paths_stay_in_their_folder) {
  for (const char* good : {"a", "a/b.txt", "a/..b", "größe/ü"}) EXPECT_TRUE(is_safe_path(good));
  for (const char* bad :
       {"", "/a", "../a", "a/../b", "a/./b", "a//b", "a/", "c:/x", "a\\b", "a\nb"})
    EXPECT_FALSE(is_safe_path(bad)) << bad;
}

TEST(Citations, missing_members_are_left_out) {
  protocol::DepositRecord record;
  record.titles.emplace(1).front().title = "A title";
  EXPECT_EQ(citation_text(record), "A title [Dataset].");
  EXPECT_EQ(bibtex(record, "key"), "@dataset{key,\n  title = {{A title}},\n}\n");
  EXPECT_EQ(ris(record), "TY  - DATA\r\nTI  - A title\r\nER  - \r\n");
  EXPECT_EQ(missing_for_doi(record),
            (std::vector<std::string>{"creators", "publisher", "year", "rights"}));
  EXPECT_EQ(datacite_name("is_part_of"), "IsPartOf");
}

}  // namespace
}  // namespace strata::app
