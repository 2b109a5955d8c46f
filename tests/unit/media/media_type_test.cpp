#include <gtest/gtest.h>

#include <string>

#include "media/media_type.h"

namespace strata {
namespace {

using namespace std::string_literals;

std::string sniff(const std::string& bytes, const std::string& name = "file") {
  return sniff_media_type({reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()},
                          name);
}

// Returns the first entry of a zip file, stored without compression.
std::string zip_entry(const std::string& name, const std::string& content = {}) {
  std::string head("PK\x03\x04\x14\0\0\0\0\0", 10);
  head += std::string(16, '\0');
  head += static_cast<char>(name.size());
  head += std::string(3, '\0');
  return head + name + content;
}

TEST(MediaType, files_are_told_by_their_first_bytes) {
  EXPECT_EQ(sniff("\xff\xd8\xff\xe1"), "image/jpeg");
  EXPECT_EQ(sniff("\x89PNG\r\n\x1a\n"), "image/png");
  EXPECT_EQ(sniff("II*\0\b\0\0\0"s), "image/tiff");
  EXPECT_EQ(sniff("MM\0*\0\0\0\b"s), "image/tiff");
  EXPECT_EQ(sniff("RIFF\x10\0\0\0WEBPVP8 "s), "image/webp");
  EXPECT_EQ(sniff("RIFF\x10\0\0\0WAVEfmt "s), "audio/wav");
  EXPECT_EQ(sniff("GIF89a\x01\0\x01\0"s), "image/gif");
  EXPECT_EQ(sniff("\0\0\0\x18"s + "ftypheic\0\0\0\0mif1"s), "image/heic");
  EXPECT_EQ(sniff("\0\0\0\x18"s + "ftypavif\0\0\0\0"s), "image/avif");
  EXPECT_EQ(sniff("\0\0\0\x18"s + "ftypisom\0\0\x02\0"s), "video/mp4");
  EXPECT_EQ(sniff("\0\0\0\x18"s + "ftypqt  \0\0\0\0"s), "video/quicktime");
  EXPECT_EQ(sniff("%PDF-1.7\n"), "application/pdf");
  EXPECT_EQ(sniff(zip_entry("mimetype", "application/vnd.oasis.opendocument.text")),
            "application/vnd.oasis.opendocument.text");
  EXPECT_EQ(sniff(zip_entry("[Content_Types].xml", "<Override PartName=\"/word/document.xml\"/>")),
            "application/vnd.openxmlformats-officedocument.wordprocessingml.document");
  EXPECT_EQ(sniff(zip_entry("[Content_Types].xml") + zip_entry("xl/workbook.xml")),
            "application/vnd.openxmlformats-officedocument.spreadsheetml.sheet");
  EXPECT_EQ(sniff(zip_entry("photos/1.jpg")), "application/zip");
}

TEST(MediaType, a_name_cannot_make_a_page_a_picture) {
  for (const char* page :
       {"<html><script>alert(1)</script>", "  \n<!DOCTYPE HTML><p>", "<ScRiPt>alert(1)</script>",
        "<!-- x --><html>", "\xef\xbb\xbf<body onload=alert(1)>", "<iframe src=x>"})
    EXPECT_EQ(sniff(page, "photo.jpg"), "text/html") << page;
  for (const char* drawing :
       {"<svg onload=alert(1)>", "<?xml version='1.0'?><svg/>", "<!-- a --> <svg xmlns=''>"})
    EXPECT_EQ(sniff(drawing, "photo.png"), "image/svg+xml") << drawing;
  EXPECT_EQ(sniff("<?xml version='1.0'?><lido/>", "a.svg"), "application/xml");
  EXPECT_FALSE(is_raster_picture("image/svg+xml"));
  EXPECT_TRUE(is_raster_picture("image/webp"));
}

TEST(MediaType, the_name_tells_only_kinds_of_plain_text_apart) {
  EXPECT_EQ(sniff("unit,depth\n1,2\n", "units.CSV"), "text/csv");
  EXPECT_EQ(sniff("{}", "a.json"), "application/json");
  EXPECT_EQ(sniff("unit 12 \xe9t\xe9", "notes"), "text/plain") << "of another encoding";
  EXPECT_EQ(sniff("MZ\x90\0\x03"s, "report.pdf"), "application/octet-stream");
  EXPECT_EQ(sniff("", "a.csv"), "application/octet-stream");
}

TEST(MediaType, no_beginning_of_a_file_reads_beyond_it) {
  for (const std::string& whole : {"RIFF\x10\0\0\0WEBP"s, "\0\0\0\x18"s + "ftypheic"s,
                                   zip_entry("[Content_Types].xml", "word/"), "\x1a\x45\xdf\xa3"s,
                                   "BM\0\0\0\0\0\0\0\0\x36\0\0\0"s, "<!DOCTYPE html>"s})
    for (std::size_t cut = 0; cut <= whole.size(); ++cut)
      EXPECT_FALSE(sniff(whole.substr(0, cut)).empty());
}

}  // namespace
}  // namespace strata
