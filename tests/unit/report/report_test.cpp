// Documents as DOCX and PDF: their texts, the size of pictures on paper, tables over many pages,
// and errors.
#include <gtest/gtest.h>
#include <zip.h>

#include <array>
#include <cstdio>
#include <fstream>
#include <pugixml.hpp>
#include <random>
#include <regex>
#include <sstream>

#include "media/picture.h"
#include "report/page.h"
#include "report/writers.h"

namespace strata::report {
namespace {

namespace fs = std::filesystem;
using Bytes = std::vector<std::uint8_t>;

// A folder that is deleted at the end of a test.
struct Folder {
  fs::path path;
  Folder() {
    std::string name = (fs::temp_directory_path() / "strata-report-XXXXXX").string();
    path = mkdtemp(name.data());
  }
  ~Folder() { fs::remove_all(path); }
};

std::string output_of(const std::string& command) {
  std::string text;
  FILE* pipe = popen(command.c_str(), "r");
  std::array<char, 4096> part;
  while (const std::size_t size = std::fread(part.data(), 1, part.size(), pipe))
    text.append(part.data(), size);
  EXPECT_EQ(pclose(pipe), 0) << command;
  return text;
}

Bytes rgba_of(int width, int height) {
  Bytes rgba;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      for (const int value : {x * 255 / width, y * 255 / height, 90, 255})
        rgba.push_back(static_cast<std::uint8_t>(value));
  return rgba;
}
PictureSource png_of(int width, int height) {
  return std::make_shared<const Bytes>(encode_png(rgba_of(width, height), width, height));
}
PictureSource jpeg_of(int width, int height) {
  return std::make_shared<const Bytes>(encode_jpeg(rgba_of(width, height), width, height, {}));
}

// The parts of a .docx file.
std::string part_of(const fs::path& file, const char* name) {
  zip_t* archive = zip_open(file.c_str(), ZIP_RDONLY | ZIP_CHECKCONS, nullptr);
  EXPECT_NE(archive, nullptr);
  zip_stat_t facts;
  EXPECT_EQ(zip_stat(archive, name, 0, &facts), 0) << name;
  std::string text(facts.size, '\0');
  zip_file_t* part = zip_fopen(archive, name, 0);
  EXPECT_EQ(zip_fread(part, text.data(), text.size()), static_cast<zip_int64_t>(text.size()));
  zip_fclose(part);
  zip_discard(archive);
  return text;
}

pugi::xml_document xml_of(const std::string& text) {
  pugi::xml_document document;
  EXPECT_TRUE(document.load_buffer(text.data(), text.size())) << text.substr(0, 200);
  return document;
}

std::string docx_text(const fs::path& file) {
  const auto document = xml_of(part_of(file, "word/document.xml"));
  std::string text;
  for (const auto& found : document.select_nodes("//w:p")) {
    for (const auto& run : found.node().select_nodes(".//w:t")) text += run.node().text().get();
    text += "\n";
  }
  return text;
}

std::string pdf_text(const fs::path& file) {
  return output_of("pdftotext -layout " + file.string() + " -");
}

Document example() {
  Document document;
  document.title = "Sherd 14";
  document.subject = "Zustandsbericht";
  document.author = "Ñandú & Söhne <1>";
  document.language = "de";
  document.created = std::chrono::sys_seconds(std::chrono::seconds(1'700'000'000));
  document.title_block = {{"Inventarnummer", "1927.14"}, {"Ort", "Ávila"}};
  document.header = "Sherd 14";
  document.footer = "Museum";
  document.blocks.emplace_back(Heading{1, "Befunde"});
  document.blocks.emplace_back(
      Paragraph{{{"Größe und Maß: ", true}, {"¿Qué? ß ü é “quoted” – 5 m²", false, true}}});
  document.blocks.emplace_back(ListItem{{{"Erstens"}}});
  document.blocks.emplace_back(ListItem{{{"Zweitens"}}});
  Table table{{{"Klasse", 3}, {"Fläche", 1, Alignment::end}}, {}};
  table.rows.push_back({Cell{"Schalen", Color{200, 30, 30}}, Cell{"12,5 cm²"}});
  table.total = {Cell{"Summe"}, Cell{"12,5 cm²"}};
  table.caption = "Mengen";
  document.blocks.emplace_back(std::move(table));
  document.blocks.emplace_back(Picture{png_of(400, 200), 100, "Ansicht von vorn", "Vorderseite"});
  document.blocks.emplace_back(PageBreak{});
  document.blocks.emplace_back(Heading{2, "Anhang"});
  document.blocks.emplace_back(Picture{jpeg_of(300, 300), 80, "Foto", "Foto vom Rand"});
  return document;
}

const char* const kTexts[] = {
    "Sherd 14", "Zustandsbericht", "Inventarnummer",  "1927.14",
    "Ávila",    "Befunde",         "Größe und Maß: ", "¿Qué? ß ü é “quoted” – 5 m²",
    "Erstens",  "Zweitens",        "Mengen",          "Klasse",
    "Schalen",  "12,5 cm²",        "Summe",           "Vorderseite",
    "Anhang",   "Foto vom Rand"};

void expect_in_order(const std::string& text) {
  std::size_t at = 0;
  for (const char* words : kTexts) {
    const auto found = text.find(words, at);
    EXPECT_NE(found, std::string::npos) << words << " in\n" << text;
    if (found != std::string::npos) at = found;
  }
}

TEST(Report, a_docx_has_all_texts_in_order_and_their_styles) {
  const Folder folder;
  const fs::path file = folder.path / "report.docx";
  Progress progress;
  const auto written = write_docx(example(), file, progress);
  ASSERT_TRUE(written) << written.error().detail;
  expect_in_order(docx_text(file));
  const auto body = xml_of(part_of(file, "word/document.xml"));
  const auto style = [&](const char* text) {
    return std::string(
        body.select_node(
                (std::string("//w:p[.//w:t='") + text + "']/w:pPr/w:pStyle/@w:val").c_str())
            .attribute()
            .value());
  };
  EXPECT_EQ(style("Befunde"), "Heading1");
  EXPECT_EQ(style("Anhang"), "Heading2");
  EXPECT_EQ(style("Vorderseite"), "Caption");
  // The width of the picture on paper is exact: 100 mm are 3 600 000 EMU.
  const auto extent = body.select_node("//wp:extent").node();
  EXPECT_EQ(extent.attribute("cx").as_int(), 3'600'000);
  EXPECT_EQ(extent.attribute("cy").as_int(), 1'800'000);
  EXPECT_EQ(std::string(body.select_node("//wp:docPr/@descr").attribute().value()),
            "Ansicht von vorn");
  const auto core = part_of(file, "docProps/core.xml");
  EXPECT_NE(core.find("Ñandú &amp; Söhne &lt;1&gt;"), std::string::npos) << core;
  EXPECT_NE(core.find("2023-11-14T22:13:20Z"), std::string::npos) << core;
}

TEST(Report, a_pdf_is_an_archivable_file_with_all_texts_in_order) {
  const Folder folder;
  const fs::path file = folder.path / "report.pdf";
  Progress progress;
  const auto written = write_pdf(example(), file, progress);
  ASSERT_TRUE(written) << written.error().detail;
  expect_in_order(pdf_text(file));
  const std::string facts = output_of("pdfinfo " + file.string());
  for (const char* line :
       {"Title: +Sherd 14", "Author: +Ñandú & Söhne <1>", "Tagged: +yes", "Encrypted: +no",
        "JavaScript: +no", "Pages: +2", "Page size: +595\\.\\d+ x 841\\.\\d+ pts \\(A4\\)"})
    EXPECT_TRUE(std::regex_search(facts, std::regex(line))) << line << " in\n" << facts;
  // PDF/A: metadata with the conformance, an intent with a color profile, and embedded fonts.
  const std::string metadata = output_of("pdfinfo -meta " + file.string());
  const auto xmp = xml_of(metadata.substr(metadata.find('<')));
  EXPECT_NE(metadata.find("pdfaid:part"), std::string::npos) << metadata;
  EXPECT_NE(metadata.find("Sherd 14"), std::string::npos);
  output_of("qpdf --check " + file.string());
  const std::string objects =
      output_of("qpdf --qdf --object-streams=disable " + file.string() + " -");
  for (const char* needed : {"/OutputIntents", "/GTS_PDFA1", "/DestOutputProfile", "/Lang", "/ID"})
    EXPECT_NE(objects.find(needed), std::string::npos) << needed;
  for (const char* forbidden : {"/Interpolate true", "/JavaScript", "/Encrypt"})
    EXPECT_EQ(objects.find(forbidden), std::string::npos) << forbidden;
  std::istringstream fonts(output_of("pdffonts " + file.string()));
  std::string line;
  int count = 0;
  while (std::getline(fonts, line)) {
    if (++count <= 2) continue;  // the names of the columns
    EXPECT_TRUE(std::regex_search(line, std::regex("(yes|no) +yes (yes|no)|yes yes"))) << line;
    EXPECT_EQ(line.find("Type 3"), std::string::npos) << line;
  }
  EXPECT_GT(count, 2);
}

TEST(Report, pictures_of_a_pdf_have_their_size_on_paper) {
  const Folder folder;
  const fs::path file = folder.path / "report.pdf";
  Progress progress;
  ASSERT_TRUE(write_pdf(example(), file, progress));
  std::istringstream list(output_of("pdfimages -list " + file.string()));
  std::string line, word;
  std::vector<std::pair<std::string, double>> images;  // the encoding, and pixels per inch
  while (std::getline(list, line)) {
    std::istringstream words(line);
    std::vector<std::string> columns;
    while (words >> word) columns.push_back(word);
    if (columns.size() > 13 && columns[2] == "image")
      images.emplace_back(columns[8], std::stod(columns[12]));
  }
  ASSERT_EQ(images.size(), 2u) << list.str();
  EXPECT_NEAR(images[0].second, 400 / (100 / 25.4), 1);
  EXPECT_NEAR(images[1].second, 300 / (80 / 25.4), 1);
  EXPECT_EQ(images[1].first, "jpeg") << "a JPEG is not encoded again";
}

TEST(Report, a_long_table_repeats_its_head_and_loses_no_row) {
  Document document;
  document.title = "Long";
  Table table{{{"Number", 1, Alignment::end}, {"Words", 3}}, {}};
  constexpr int kRows = 500;
  for (int i = 0; i < kRows; ++i)
    table.rows.push_back({Cell{"row" + std::to_string(i) + "."}, Cell{"some words"}});
  document.blocks.emplace_back(std::move(table));
  const Folder folder;
  Progress progress;
  const fs::path pdf = folder.path / "long.pdf", docx = folder.path / "long.docx";
  ASSERT_TRUE(write_pdf(document, pdf, progress));
  ASSERT_TRUE(write_docx(document, docx, progress));
  const std::string in_pdf = pdf_text(pdf), in_docx = docx_text(docx);
  for (int i = 0; i < kRows; ++i) {
    const std::string words = "row" + std::to_string(i) + ".";
    EXPECT_NE(in_pdf.find(words), std::string::npos) << words;
    EXPECT_NE(in_docx.find(words), std::string::npos) << words;
  }
  std::istringstream pages(in_pdf);
  std::string page;
  int count = 0;
  while (std::getline(pages, page, '\f')) {
    if (page.find("row") == std::string::npos) continue;
    ++count;
    EXPECT_NE(page.find("Number"), std::string::npos) << page.substr(0, 300);
  }
  EXPECT_GT(count, 5);
  const auto body = xml_of(part_of(docx, "word/document.xml"));
  EXPECT_TRUE(body.select_node("//w:tr[1]/w:trPr/w:tblHeader"));
}

TEST(Report, a_short_table_stays_on_one_page) {
  Document document;
  constexpr int kTables = 40, kRows = 5;
  const auto words = [](int table, int row) {
    return "table" + std::to_string(table) + "row" + std::to_string(row) + ".";
  };
  for (int i = 0; i < kTables; ++i) {
    Table table{{{"", 1}, {"", 2}}, {}};
    for (int row = 0; row < kRows; ++row)
      table.rows.push_back({Cell{"Width"}, Cell{words(i, row)}});
    document.blocks.emplace_back(std::move(table));
  }
  const Folder folder;
  Progress progress;
  const fs::path pdf = folder.path / "short.pdf";
  ASSERT_TRUE(write_pdf(document, pdf, progress));
  std::istringstream pages(pdf_text(pdf));
  std::string page;
  int count = 0, complete = 0;
  while (std::getline(pages, page, '\f')) {
    ++count;
    for (int i = 0; i < kTables; ++i)
      if (page.find(words(i, 0)) != std::string::npos)
        complete += page.find(words(i, kRows - 1)) != std::string::npos ? 1 : 0;
  }
  EXPECT_GT(count, 3);
  EXPECT_EQ(complete, kTables);
}

TEST(Report, a_table_that_arranges_pictures_has_no_lines) {
  Document document;
  const CellPicture picture{png_of(40, 20), 30, "A crack"};
  document.blocks.emplace_back(
      Table{{{"", 1}, {"", 1}}, {{Cell{"Crack", {}, picture}, Cell{"Rim", {}, picture}}}});
  document.blocks.emplace_back(
      Table{{{"", 1}, {"", 1}}, {{Cell{"Crack", {}, picture}, Cell{"2 mm"}}}});
  const Folder folder;
  Progress progress;
  const fs::path docx = folder.path / "pictures.docx", pdf = folder.path / "pictures.pdf";
  ASSERT_TRUE(write_docx(document, docx, progress));
  const auto body = xml_of(part_of(docx, "word/document.xml"));
  std::vector<std::string> styles;
  for (const auto& style : body.select_nodes("//w:tblStyle/@w:val"))
    styles.emplace_back(style.attribute().value());
  EXPECT_EQ(styles, (std::vector<std::string>{"PlainTable", "ReportTable"}));
  const auto has_lines = [&](std::size_t block) {
    Document one;
    one.blocks.push_back(document.blocks[block]);
    EXPECT_TRUE(write_pdf(one, pdf, progress));
    // only lines reach the right margin of the text, in points
    return output_of("pdftocairo -svg " + pdf.string() + " -").find(" 537.9") != std::string::npos;
  };
  EXPECT_FALSE(has_lines(0));
  EXPECT_TRUE(has_lines(1));
}

// Random words, also hostile ones.
std::string words_of(std::mt19937& random) {
  static const char* const kWords[] = {"a",
                                       "Größe",
                                       "¿qué?",
                                       "<b>&amp;\"'",
                                       "\x01\x02\x7f",
                                       "\xff\xfe broken",
                                       "العربية",
                                       "עברית",
                                       "🗿",
                                       "line\nbreak",
                                       "tab\there",
                                       "Donaudampfschifffahrtsgesellschaft",
                                       "",
                                       "漢字",
                                       "\uFFFE",
                                       "%s{}",
                                       "5 m²",
                                       "]]>"};
  std::uniform_int_distribution<std::size_t> count(0, 30), which(0, std::size(kWords) - 1);
  std::string text;
  for (std::size_t i = count(random); i > 0; --i) text += std::string(kWords[which(random)]) + " ";
  if (which(random) == 0) text += std::string(3000, 'x');  // a word that is longer than a page
  return text;
}

PictureSource picture_of(std::mt19937& random) {
  std::uniform_int_distribution<int> side(1, 90);
  return random() % 2 == 0 ? png_of(side(random), side(random))
                           : jpeg_of(side(random), side(random));
}

Block block_of(std::mt19937& random) {
  std::uniform_real_distribution<double> width(1, 260);
  switch (random() % 7) {
    case 0: return Heading{static_cast<int>(1 + random() % 3), words_of(random)};
    case 1: return Paragraph{{{words_of(random)}, {words_of(random), true}, {words_of(random)}}};
    case 2: return ListItem{{{words_of(random)}}};
    case 3: return PageBreak{};
    case 4: {
      Table table;
      const std::size_t columns = 1 + random() % 5;
      for (std::size_t i = 0; i < columns; ++i)
        table.columns.push_back({random() % 2 == 0 ? "" : words_of(random), 0.1 + i,
                                 static_cast<Alignment>(random() % 3)});
      for (std::size_t i = random() % 12; i > 0; --i) {
        auto& row = table.rows.emplace_back();
        for (std::size_t c = random() % (columns + 1); c > 0; --c) {
          Cell cell{words_of(random)};
          if (random() % 4 == 0) cell.swatch = Color{9, 99, 199};
          if (random() % 4 == 0) cell.picture = CellPicture{picture_of(random), width(random), "x"};
          row.push_back(std::move(cell));
        }
      }
      if (random() % 2 == 0) table.total = {Cell{words_of(random)}};
      if (random() % 2 == 0) table.caption = words_of(random);
      return table;
    }
    default: return Picture{picture_of(random), width(random), words_of(random), words_of(random)};
  }
}

TEST(Report, any_document_can_be_written_and_read) {
  const Folder folder;
  std::mt19937 random(11);
  constexpr int kDocuments = 25;
  for (int i = 0; i < kDocuments; ++i) {
    Document document;
    document.title = words_of(random);
    document.subject = words_of(random);
    document.author = words_of(random);
    document.header = words_of(random);
    document.footer = words_of(random);
    if (random() % 2 == 0) document.logo = Logo{picture_of(random), 30, "logo"};
    for (std::size_t n = random() % 6; n > 0; --n)
      document.title_block.emplace_back(words_of(random), words_of(random));
    for (std::size_t n = random() % 25; n > 0; --n) document.blocks.push_back(block_of(random));
    const std::string name = "any" + std::to_string(i);
    const fs::path pdf = folder.path / (name + ".pdf"), docx = folder.path / (name + ".docx");
    Progress progress;
    const auto as_pdf = write_pdf(document, pdf, progress),
               as_docx = write_docx(document, docx, progress);
    ASSERT_TRUE(as_pdf) << i << as_pdf.error().detail << as_pdf.error().field;
    ASSERT_TRUE(as_docx) << i << as_docx.error().detail << as_docx.error().field;
    EXPECT_NE(output_of("pdfinfo " + pdf.string()).find("Pages:"), std::string::npos) << i;
    EXPECT_EQ(output_of("pdftotext " + pdf.string() + " - 2>&1 >/dev/null"), "") << i;
    xml_of(part_of(docx, "word/document.xml"));
  }
}

TEST(Report, the_same_document_gives_the_same_bytes) {
  const Folder folder;
  const auto bytes_of = [&](auto write, const char* name) {
    const fs::path file = folder.path / name;
    Progress progress;
    EXPECT_TRUE(write(example(), file, progress));
    std::ifstream in(file, std::ios::binary);
    return std::string((std::istreambuf_iterator<char>(in)), {});
  };
  EXPECT_EQ(bytes_of(write_pdf, "a.pdf"), bytes_of(write_pdf, "b.pdf"));
  EXPECT_EQ(bytes_of(write_docx, "a.docx"), bytes_of(write_docx, "b.docx"));
}

TEST(Report, a_picture_that_is_too_large_is_reduced_and_the_caption_says_so) {
  Document document;
  document.blocks.emplace_back(Picture{png_of(340, 100), 340, "", "Whole wall"});
  const Folder folder;
  const fs::path file = folder.path / "wide.pdf", docx = folder.path / "wide.docx";
  Progress progress;
  ASSERT_TRUE(write_pdf(document, file, progress));
  ASSERT_TRUE(write_docx(document, docx, progress));
  const std::string percent = std::to_string(std::lround(100 * kMaxPictureWidth_mm / 340));
  for (const std::string& text : {pdf_text(file), docx_text(docx)})
    EXPECT_NE(text.find("Reduced to " + percent + " %"), std::string::npos) << text;
}

TEST(Report, pictures_that_cannot_be_read_are_refused) {
  const Folder folder;
  const auto text = std::make_shared<const Bytes>(Bytes{'t', 'e', 'x', 't'});
  auto broken = encode_png(rgba_of(50, 50), 50, 50);
  broken.resize(broken.size() / 2);
  const struct {
    PictureSource source;
    ErrorCode code;
  } cases[] = {{text, ErrorCode::unsupported},
               {std::make_shared<const Bytes>(broken), ErrorCode::invalid},
               {folder.path / "missing.png", ErrorCode::damaged}};
  for (const auto& [source, code] : cases)
    for (const bool is_pdf : {true, false}) {
      Document document;
      document.blocks.emplace_back(Paragraph{{{"Text"}}});
      document.blocks.emplace_back(Picture{source, 50, "", ""});
      const fs::path file = folder.path / "refused";
      Progress progress;
      const auto written =
          is_pdf ? write_pdf(document, file, progress) : write_docx(document, file, progress);
      ASSERT_FALSE(written);
      EXPECT_EQ(written.error().code, code) << written.error().detail;
      EXPECT_TRUE(written.error().field.starts_with("blocks/1")) << written.error().field;
      EXPECT_TRUE(fs::is_empty(folder.path)) << "a file remains";
    }
}

TEST(Report, wrong_values_are_refused_with_their_place) {
  const Folder folder;
  const auto refused = [&](const Document& document) {
    Progress progress;
    const auto written = write_docx(document, folder.path / "wrong.docx", progress);
    EXPECT_FALSE(written);
    return written ? std::string() : written.error().field;
  };
  Document heading, table, picture;
  heading.blocks.emplace_back(Heading{4, "Too deep"});
  EXPECT_TRUE(refused(heading).starts_with("blocks/0"));
  table.blocks.emplace_back(Table{{{"One", 1}}, {{Cell{"1"}, Cell{"2"}}}});
  EXPECT_TRUE(refused(table).starts_with("blocks/0"));
  picture.blocks.emplace_back(Picture{png_of(2, 2), -1, "", ""});
  EXPECT_TRUE(refused(picture).starts_with("blocks/0"));
}

TEST(Report, a_cancelled_report_leaves_no_file) {
  const Folder folder;
  Progress progress;
  progress.cancel();
  for (const auto& written : {write_pdf(example(), folder.path / "a.pdf", progress),
                              write_docx(example(), folder.path / "a.docx", progress)}) {
    ASSERT_FALSE(written);
    EXPECT_EQ(written.error().code, ErrorCode::cancelled);
  }
  EXPECT_TRUE(fs::is_empty(folder.path));
}

TEST(Report, a_report_is_written_if_there_is_a_disk_to_write_to) {
  Progress progress;
  for (const auto& written : {write_pdf(example(), "/nonexistent/a.pdf", progress),
                              write_docx(example(), "/nonexistent/a.docx", progress)}) {
    ASSERT_FALSE(written);
    EXPECT_EQ(written.error().code, ErrorCode::storage_full) << written.error().detail;
  }
}

TEST(Report, a_full_disk_is_an_error) {
  const Folder folder;
  // /dev/full accepts no bytes. The second file is the one that cairo writes.
  for (const char* name : {"full.pdf", "full.pdf.drawn"}) {
    fs::create_symlink("/dev/full", folder.path / name);
    Progress progress;
    const auto written = write_pdf(example(), folder.path / "full.pdf", progress);
    ASSERT_FALSE(written) << name;
    EXPECT_EQ(written.error().code, ErrorCode::storage_full) << written.error().detail;
    EXPECT_TRUE(fs::is_empty(folder.path));
  }
}

TEST(Report, an_empty_document_has_a_page) {
  const Folder folder;
  Progress progress;
  ASSERT_TRUE(write_pdf({}, folder.path / "a.pdf", progress));
  ASSERT_TRUE(write_docx({}, folder.path / "a.docx", progress));
  EXPECT_NE(output_of("pdfinfo " + (folder.path / "a.pdf").string()).find("Pages:           1"),
            std::string::npos);
}

TEST(Report, libreoffice_opens_the_docx) {
  if (std::system("command -v soffice >/dev/null") != 0)
    GTEST_SKIP() << "LibreOffice is not installed (package libreoffice-writer-nogui)";
  const Folder folder;
  const fs::path file = folder.path / "report.docx";
  Progress progress;
  ASSERT_TRUE(write_docx(example(), file, progress));
  output_of("cd " + folder.path.string() + " && HOME=" + folder.path.string() +
            " soffice --headless --convert-to pdf report.docx 2>&1");
  expect_in_order(pdf_text(folder.path / "report.pdf"));
}

}  // namespace
}  // namespace strata::report
