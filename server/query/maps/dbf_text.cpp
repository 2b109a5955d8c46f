#include "query/maps/dbf_text.h"

#include <iconv.h>

#include <algorithm>
#include <cctype>

namespace strata::query {
namespace {

// Owns the result of iconv_open, which is not a real pointer.
class Converter {
 public:
  explicit Converter(const std::string& encoding)
      : handle_(iconv_open("UTF-8", encoding.c_str())) {}
  Converter(const Converter&) = delete;
  Converter& operator=(const Converter&) = delete;
  ~Converter() {
    if (is_open()) iconv_close(handle_);
  }
  bool is_open() const { return handle_ != reinterpret_cast<iconv_t>(-1); }
  // Returns an empty text if `text` is not valid in that encoding.
  std::string convert(std::string_view text) const {
    std::string out(text.size() * 4, '\0');
    char* from = const_cast<char*>(text.data());  // iconv's interface is not const-correct
    char* to = out.data();
    std::size_t left = text.size(), room = out.size();
    if (iconv(handle_, &from, &left, &to, &room) == static_cast<std::size_t>(-1)) return {};
    out.resize(out.size() - room);
    return out;
  }

 private:
  iconv_t handle_;
};

std::string iconv_name(std::string_view named) {
  std::string name;
  for (const char c : named)
    if (std::isalnum(static_cast<unsigned char>(c)))
      name += static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  if (name.starts_with("LDID")) {
    const std::string number = name.substr(4);
    if (number == "3" || number == "87" || number == "88" || number == "89") return "CP1252";
    if (number == "1") return "CP437";
    if (number == "2" || number == "55") return "CP850";
    if (number == "100" || number == "200") return number == "100" ? "CP852" : "CP1250";
    if (number == "101") return "CP866";
    if (number == "201") return "CP1251";
    if (number == "203") return "CP1253";
    return {};
  }
  if (name.empty() || name.size() > 20) return {};
  if (name == "UTF8" || name == "65001") return "UTF-8";
  if (name.starts_with("88591") || name.starts_with("ISO8859")) {
    const std::string part = name.substr(name.find("8859") + 4);
    return "ISO-8859-" + (part.empty() ? "1" : part);
  }
  const bool is_number =
      std::all_of(name.begin(), name.end(), [](char c) { return c >= '0' && c <= '9'; });
  if (is_number) return "CP" + name;
  if (name.starts_with("ANSI") || name.starts_with("WINDOWS")) {
    const std::string page = name.substr(name.find_first_of("0123456789") == std::string::npos
                                             ? name.size()
                                             : name.find_first_of("0123456789"));
    return page.empty() ? std::string("CP1252") : "CP" + page;
  }
  return name;
}

}  // namespace

DbfText::DbfText(std::string_view cpg, const char* code_page) {
  for (const std::string_view named : {cpg, std::string_view(code_page ? code_page : "")}) {
    const std::string name = iconv_name(named.substr(0, 40));
    if (name.empty() || !Converter(name).is_open()) continue;
    encoding_ = name;
    return;
  }
}

std::string DbfText::utf8(std::string_view text) const {
  while (!text.empty() && text.back() == ' ') text.remove_suffix(1);
  const bool is_ascii = std::all_of(text.begin(), text.end(),
                                    [](char c) { return static_cast<unsigned char>(c) < 128; });
  if (is_ascii) return std::string(text);
  for (const char* encoding : {encoding_.c_str(), "UTF-8", "CP1252", "ISO-8859-1"}) {
    if (*encoding == '\0') continue;
    const Converter converter{encoding};
    if (!converter.is_open()) continue;
    if (std::string converted = converter.convert(text); !converted.empty()) return converted;
  }
  return {};
}

}  // namespace strata::query
