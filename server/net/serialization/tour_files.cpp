#include "net/serialization/tour_files.h"

#include <array>

namespace strata::net {
namespace {

using Kind = protocol::TourFileKind;

struct Type {
  std::string_view media_type;
  Kind kind;
};
// The types that the browsers of kiosks can show or play.
constexpr std::array kTypes{Type{"image/jpeg", Kind::picture}, Type{"image/png", Kind::picture},
                            Type{"image/webp", Kind::picture}, Type{"audio/mpeg", Kind::sound},
                            Type{"audio/mp4", Kind::sound},    Type{"audio/wav", Kind::sound},
                            Type{"audio/flac", Kind::sound},   Type{"audio/ogg", Kind::sound},
                            Type{"video/mp4", Kind::video},    Type{"video/webm", Kind::video},
                            Type{"text/vtt", Kind::subtitles}};

Result<Kind> kind_of(std::int64_t id, const TourFilesById& files, const std::string& field) {
  const auto file = files.find(store::TourFileId(id));
  if (file == files.end())
    return fail(ErrorCode::invalid, "File not found",
                "The tour has no file " + std::to_string(id) + ". Add the file to the tour first.",
                field);
  return tour_file_kind(file->second.media_type).value_or(Kind::subtitles);
}

Result<void> check_medium(const protocol::TourMedium& medium, const TourFilesById& files,
                          const std::string& here) {
  const Kind kind = STRATA_TRY(kind_of(medium.file, files, here + ".file"));
  if (kind == Kind::subtitles)
    return fail(ErrorCode::invalid, "Not a picture, sound or video",
                "Use this file as `subtitles` of a video.", here + ".file");
  if (!medium.subtitles) return {};
  if (kind != Kind::video && !medium.subtitles->empty())
    return fail(ErrorCode::invalid, "Not a video", "Only videos can have subtitles.",
                here + ".subtitles");
  for (const auto& [language, id] : *medium.subtitles) {
    const std::string field = here + ".subtitles." + language;
    const Kind of_text = STRATA_TRY(kind_of(id, files, field));
    if (of_text != Kind::subtitles)
      return fail(ErrorCode::invalid, "Not subtitles",
                  "Subtitles must be a file in the WebVTT format.", field);
  }
  return {};
}

}  // namespace

std::optional<Kind> tour_file_kind(std::string_view media_type) {
  for (const Type& type : kTypes)
    if (type.media_type == media_type) return type.kind;
  return std::nullopt;
}

nlohmann::json to_json(const store::TourFile& file) {
  nlohmann::json json{
      {"id", file.id},
      {"name", file.name},
      {"kind", protocol::name(tour_file_kind(file.media_type).value_or(Kind::subtitles))},
      {"media_type", file.media_type},
      {"bytes", file.bytes}};
  if (file.width && file.height) {
    json["width"] = *file.width;
    json["height"] = *file.height;
  }
  return json;
}

Result<void> check_media(const std::vector<protocol::TourMedium>& media, const TourFilesById& files,
                         const std::string& field) {
  std::set<std::int64_t> known;
  for (std::size_t i = 0; i < media.size(); ++i) {
    const std::string here = field + "[" + std::to_string(i) + "]";
    if (!known.insert(media[i].file).second)
      return fail(ErrorCode::invalid, "Duplicate file", "This file appears twice. Send it once.",
                  here + ".file");
    STRATA_TRY(check_medium(media[i], files, here));
  }
  return {};
}

Result<void> check_logo(const protocol::TourTheme& theme, const TourFilesById& files) {
  if (!theme.logo) return {};
  const Kind kind = STRATA_TRY(kind_of(*theme.logo, files, "theme.logo"));
  if (kind != Kind::picture)
    return fail(ErrorCode::invalid, "Not a picture",
                "The logo must be a picture: PNG, WebP or JPEG.", "theme.logo");
  return {};
}

std::set<store::TourFileId> files_in(const nlohmann::json& content) {
  std::set<store::TourFileId> used;
  for (const nlohmann::json& stop : content.at("stops")) {
    const auto media = stop.find("media");
    if (media == stop.end()) continue;
    for (const nlohmann::json& medium : *media) {
      used.insert(medium.at("file").get<store::TourFileId>());
      if (const auto subtitles = medium.find("subtitles"); subtitles != medium.end())
        for (const auto& [language, id] : subtitles->items())
          used.insert(id.get<store::TourFileId>());
    }
  }
  if (const auto theme = content.find("theme"); theme != content.end() && theme->contains("logo"))
    used.insert(theme->at("logo").get<store::TourFileId>());
  return used;
}

}  // namespace strata::net
