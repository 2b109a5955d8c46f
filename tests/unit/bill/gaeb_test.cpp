#include "bill/gaeb.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <pugixml.hpp>

#include "bill/check_bill.h"
#include "bill/items.h"

namespace strata::bill {
namespace {

// Written like the files of programs for tenders: with notes, formatting and an index.
constexpr const char* kTender = R"(<?xml version="1.0" encoding="UTF-8"?>
<GAEB xmlns="http://www.gaeb.de/GAEB_DA_XML/DA83/3.3">
 <GAEBInfo><Version>3.3</Version><VersDate>2021-05</VersDate></GAEBInfo>
 <PrjInfo><NamePrj>Villa</NamePrj><Cur>EUR</Cur></PrjInfo>
 <Award><DP>83</DP><BoQ ID="B"><BoQInfo><Name>1</Name><LblBoQ>Fassade Süd</LblBoQ></BoQInfo>
  <BoQBody>
   <BoQCtgy ID="C1" RNoPart="01"><LblTx><p><span>Naturstein</span></p></LblTx>
    <BoQBody>
     <Remark ID="R1"><Description><CompleteText><DetailTxt><Text><p>Gerüst
       bauseits</p></Text></DetailTxt></CompleteText></Description></Remark>
     <Itemlist>
      <Item ID="I1" RNoPart="0010"><Qty>120.500</Qty><QU>m2</QU>
       <Description><CompleteText>
        <DetailTxt><Text><p><span>Reinigen mit  Wasser.</span></p><p>Zweiter<br/>Absatz</p></Text></DetailTxt>
        <OutlineText><OutlTxt><TextOutlTxt><p><span>Stein </span><span>reinigen</span></p></TextOutlTxt></OutlTxt></OutlineText>
       </CompleteText></Description></Item>
      <Item ID="I2" RNoPart="0010" RNoIndex="A"><Qty>1</Qty><QU>psch</QU><UP>99.5</UP></Item>
     </Itemlist>
    </BoQBody>
   </BoQCtgy>
  </BoQBody>
 </BoQ></Award>
</GAEB>)";

GaebBill tender() { return read_gaeb(kTender).value(); }

std::string with(std::string text, std::string_view what, std::string_view by) {
  return text.replace(text.find(what), what.size(), by);
}

std::vector<Position> positions_of(const protocol::BillWrite& bill) {
  std::vector<Position> positions;
  for (const auto& item : items_of(bill)) positions.push_back(measure(item, {}).value());
  return positions;
}

std::string written(const protocol::BillWrite& bill, GaebPhase phase) {
  const auto text =
      write_gaeb(bill, positions_of(bill), phase, {"Villa Süd", "2026-12-01", "09:30:00"});
  return text ? *text : "error: " + text.error().title;
}

TEST(ReadGaeb, keeps_the_tree_the_texts_and_the_quantities) {
  const GaebBill read = tender();
  EXPECT_EQ(read.phase, "83");
  EXPECT_EQ(read.bill.name, "Fassade Süd");
  const auto items = items_of(read.bill);
  ASSERT_EQ(items.size(), 3U);
  EXPECT_EQ(items[0].kind, protocol::BillItemKind::group);
  EXPECT_EQ(items[0].short_text, "Naturstein");
  EXPECT_EQ(items[0].long_text, "Gerüst bauseits");
  EXPECT_EQ(items[1].number, "01.0010");
  EXPECT_EQ(items[1].short_text, "Stein reinigen");
  EXPECT_EQ(items[1].long_text, "Reinigen mit Wasser.\nZweiter\nAbsatz");
  EXPECT_EQ(items[1].quantity, "120.5");
  EXPECT_EQ(items[1].unit, "m2");
  EXPECT_EQ(items[2].number, "01.0010_A");
  EXPECT_EQ(items[2].unit_price, "99.5");
  EXPECT_TRUE(check_bill(read.bill));
}

TEST(ReadGaeb, accepts_prefixes_and_other_encodings) {
  const std::string prefixed =
      R"(<g:GAEB xmlns:g="http://www.gaeb.de/GAEB_DA_XML/DA81/3.2"><g:Award><g:DP>81</g:DP><g:BoQ>)"
      R"(<g:BoQBody><g:Itemlist><g:Item RNoPart="1"><g:QU>m</g:QU></g:Item></g:Itemlist></g:BoQBody>)"
      R"(</g:BoQ></g:Award></g:GAEB>)";
  EXPECT_EQ(items_of(read_gaeb(prefixed)->bill).front().unit, "m");
  const std::string latin =
      "<?xml version=\"1.0\" encoding=\"ISO-8859-1\"?>" +
      with(with(kTender, "<?xml version=\"1.0\" encoding=\"UTF-8\"?>", ""), "Naturstein", "T\xfcr");
  EXPECT_EQ(items_of(read_gaeb(latin)->bill).front().short_text, "Tür");
}

TEST(ReadGaeb, refuses_other_formats_with_what_to_do) {
  const auto title = [](std::string_view bytes) {
    const auto read = read_gaeb(bytes);
    return read ? std::string("read") : read.error().title;
  };
  EXPECT_EQ(title("#begin[GAEB]\r\n#end[GAEB]"), "GAEB 2000 file");
  EXPECT_EQ(title("00        83L      1122PPPPI\r\n"), "Not a GAEB DA XML file");
  EXPECT_EQ(title(""), "Not a GAEB DA XML file");
  EXPECT_EQ(title("<html/>"), "Not a GAEB DA XML file");
  EXPECT_EQ(title("<GAEB><Award>"), "XML not readable");
  EXPECT_EQ(title("<GAEB><Award><DP>83</DP></Award></GAEB>"), "No bill in the file");
  EXPECT_EQ(title("<GAEB><QtyDeterm><DP>31</DP></QtyDeterm></GAEB>"), "Phase not supported");
  EXPECT_EQ(title(with(kTender, "120.500", "many")), "Number not readable");
  EXPECT_EQ(title(with(kTender, "RNoPart=\"01\"", "RNoPart=\"1.2\"")),
            "Ordinal number not readable");
  EXPECT_EQ(title(std::string(kMaxGaebBytes + 1, ' ')), "File too large");
}

TEST(ReadGaeb, bounds_levels_positions_and_texts) {
  std::string deep, close;
  for (int i = 0; i < 9; ++i) {
    deep += "<BoQCtgy RNoPart=\"1\"><BoQBody>";
    close += "</BoQBody></BoQCtgy>";
  }
  const std::string before = "<GAEB><Award><DP>83</DP><BoQ><BoQBody>",
                    after = "</BoQBody></BoQ></Award></GAEB>";
  EXPECT_EQ(read_gaeb(before + deep + close + after).error().title, "Too many levels");
  std::string many = "<Itemlist>";
  for (int i = 0; i < 5001; ++i) many += "<Item RNoPart=\"" + std::to_string(i) + "\"/>";
  EXPECT_EQ(read_gaeb(before + many + "</Itemlist>" + after).error().title, "Too many positions");
  std::string nested;
  for (int i = 0; i < 100'000; ++i) nested += "<p>";
  EXPECT_FALSE(read_gaeb(before + nested + after));  // does not overflow the stack
  const auto read = read_gaeb(with(kTender, "Naturstein", std::string(3000, 'x')));
  EXPECT_EQ(items_of(read->bill).front().short_text.size(), 1000U);
  EXPECT_EQ(read->remarks.size(), 1U);
}

TEST(WriteGaeb, a_tender_is_read_back_unchanged) {
  protocol::BillWrite bill = tender().bill;
  for (auto& item : *bill.items) item.unit_price.reset();
  bill.items->front().long_text.clear();  // notes of groups are not written
  const auto back = read_gaeb(written(bill, GaebPhase::x83));
  ASSERT_TRUE(back);
  EXPECT_EQ(back->phase, "83");
  bill.items->back().short_text = "0010_A";
  auto expected = bill;
  expected.items->back().short_text = back->bill.items->back().short_text;
  EXPECT_EQ(back->bill.items, expected.items);
}

// The order of elements in the schema of GAEB DA XML 3.3.
std::vector<std::string> children(pugi::xml_node node) {
  std::vector<std::string> names;
  for (const auto& child : node.children()) names.emplace_back(child.name());
  return names;
}

TEST(WriteGaeb, has_the_elements_of_each_phase_in_the_order_of_the_schema) {
  protocol::BillWrite bill = tender().bill;
  for (auto& item : *bill.items)
    if (item.kind == protocol::BillItemKind::position) item.unit_price = "2.05";
  const auto root = [&](pugi::xml_document& document, GaebPhase phase) {
    EXPECT_TRUE(document.load_string(written(bill, phase).c_str()));
    return document.document_element();
  };
  using Names = std::vector<std::string>;
  pugi::xml_document document;
  auto gaeb = root(document, GaebPhase::x83);
  EXPECT_STREQ(gaeb.attribute("xmlns").value(), "http://www.gaeb.de/GAEB_DA_XML/DA83/3.3");
  EXPECT_EQ(children(gaeb), (Names{"GAEBInfo", "PrjInfo", "Award"}));
  EXPECT_EQ(children(gaeb.child("GAEBInfo")),
            (Names{"Version", "VersDate", "Date", "Time", "ProgSystem"}));
  auto boq = gaeb.child("Award").child("BoQ");
  EXPECT_EQ(children(boq.child("BoQInfo")),
            (Names{"Name", "LblBoQ", "Date", "OutlCompl", "BoQBkdn", "BoQBkdn"}));
  auto item = boq.first_element_by_path("BoQBody/BoQCtgy/BoQBody/Itemlist/Item");
  EXPECT_EQ(children(item), (Names{"Qty", "QU", "Description"}));
  EXPECT_STREQ(item.next_sibling().attribute("RNoIndex").value(), "A");

  gaeb = root(document, GaebPhase::x84);
  item = gaeb.first_element_by_path("Award/BoQ/BoQBody/BoQCtgy/BoQBody/Itemlist/Item");
  EXPECT_EQ(children(item), (Names{"Qty", "QU", "UP", "IT"}));
  EXPECT_STREQ(item.child_value("IT"), "247.03");  // 120.5 * 2.05 = 247.025

  gaeb = root(document, GaebPhase::x31);
  EXPECT_EQ(children(gaeb), (Names{"GAEBInfo", "QtyDeterm"}));
  EXPECT_EQ(children(gaeb.child("QtyDeterm")), (Names{"PrjInfo", "QtyDetermInfo", "DP", "BoQ"}));
  EXPECT_EQ(children(gaeb.child("QtyDeterm").child("BoQ")),
            (Names{"RefBoQName", "BoQBkdn", "BoQBkdn", "BoQBody"}));
}

TEST(WriteGaeb, units_have_at_most_four_characters) {
  protocol::BillWrite bill = tender().bill;
  const auto unit = [&](const std::string& name) {
    bill.items->at(1).unit = name;
    pugi::xml_document document;
    EXPECT_TRUE(document.load_string(written(bill, GaebPhase::x83).c_str()));
    return std::string(document.document_element()
                           .first_element_by_path("Award/BoQ/BoQBody/BoQCtgy/BoQBody/Itemlist/Item")
                           .child_value("QU"));
  };
  EXPECT_EQ(unit("m²"), "m²");
  EXPECT_EQ(unit("psch"), "psch");
  EXPECT_EQ(unit("Stück"), "St");
  EXPECT_EQ(unit("lfdm."), "m");
}

// Rounded, the receiver would compute other totals than the bill has.
TEST(WriteGaeb, numbers_with_more_places_than_gaeb_allows_are_refused) {
  protocol::BillWrite bill = tender().bill;
  bill::GaebFacts facts{};
  for (auto& item : *bill.items)
    if (item.kind == protocol::BillItemKind::position) item.unit_price = "0.125";
  std::vector<bill::Position> positions(bill.items->size());
  const auto bid = write_gaeb(bill, positions, GaebPhase::x84, facts);
  ASSERT_FALSE(bid);
  EXPECT_THAT(bid.error().detail, testing::HasSubstr("unit price of position"));
  for (auto& item : *bill.items)
    if (item.kind == protocol::BillItemKind::position) item.unit_price = "1000";
  for (auto& each : positions) each.quantity = *bill::ExactNumber::parse("1.2345");
  for (const GaebPhase phase : {GaebPhase::x31, GaebPhase::x86}) {
    const auto contract = write_gaeb(bill, positions, phase, facts);
    ASSERT_FALSE(contract);
    EXPECT_THAT(contract.error().detail, testing::HasSubstr("quantity of position"));
  }
}

TEST(WriteGaeb, notes_of_groups_come_back) {
  protocol::BillWrite bill = tender().bill;
  bill.items->front().long_text = "Preamble.\n\nScaffold by others.";
  const auto again = read_gaeb(written(bill, GaebPhase::x83));
  ASSERT_TRUE(again) << again.error().detail;
  EXPECT_EQ(items_of(again->bill).front().long_text, "Preamble.\nScaffold by others.");
}

TEST(WriteGaeb, proof_lines_are_rows_of_80_characters) {
  protocol::BillWrite bill = tender().bill;
  protocol::HandMeasurement plain, long_text;
  plain.formula = "2 * 1,20 * 0,85";
  plain.text = "Sockel Süd";
  long_text.formula = "(1,5 + 1,5 + 1,5 + 1,5 + 1,5 + 1,5) * 2";
  long_text.text = std::string(60, 'x');
  bill.items->at(1).measurements = {plain, long_text};
  pugi::xml_document document;
  ASSERT_TRUE(document.load_string(written(bill, GaebPhase::x31).c_str()));
  const auto proof = document.document_element().first_element_by_path(
      "QtyDeterm/BoQ/BoQBody/BoQCtgy/BoQBody/Itemlist/Item/QtyDeterm");
  EXPECT_STREQ(proof.child_value("Qty"), "20.040");
  std::vector<std::string> rows;
  for (const auto& item : proof.children("QDetermItem"))
    rows.emplace_back(item.child("QTakeoff").attribute("Row").value());
  ASSERT_EQ(rows.size(), 6U);
  EXPECT_EQ(rows[0].size(), 81U);  // 80 characters, one with two bytes
  EXPECT_EQ(rows[0].substr(12, 12), "*Sockel Süd");
  EXPECT_EQ(rows[1].size(), 80U);
  EXPECT_EQ(rows[1].substr(29, 2), "91");
  EXPECT_EQ(rows[1].substr(33, 17), "2 * 1,20 * 0,85= ");
  EXPECT_EQ(rows[1].substr(69, 6), "0001B0");
  EXPECT_EQ(rows[5].substr(33, 4), "18= ");  // too long to be kept; the comment has the formula
}

TEST(WriteGaeb, refuses_what_the_format_does_not_allow) {
  protocol::BillWrite bill = tender().bill;
  EXPECT_EQ(written(bill, GaebPhase::x84), "error: Price missing");
  bill.items->at(1).unit.clear();
  EXPECT_EQ(written(bill, GaebPhase::x83), "error: Unit missing");
  bill.items->at(1).unit = "Wochen";
  EXPECT_EQ(written(bill, GaebPhase::x83), "error: Unit too long for GAEB");
  bill = tender().bill;
  protocol::BillItem high;
  high.number = "02";
  bill.items->push_back(high);
  EXPECT_EQ(written(bill, GaebPhase::x83), "error: Positions on different levels");
}

}  // namespace
}  // namespace strata::bill
