#include "store/content/tour_files.h"

#include "store/pg/blobs.h"
#include "store/pg/pg_row.h"
#include "store/pg/sql.h"
#include "store/store_impl.h"

namespace strata::store {
namespace {

constexpr auto kTourFiles =
    sql("SELECT f.id, f.tour_id, f.name, f.media_type, b.bytes, encode(f.sha256, 'hex'), f.width, "
        "f.height FROM tour_files f JOIN blobs b USING (sha256) ");

TourFile read_tour_file(const PgResult& rows, int i) {
  PgRow row(rows, i);
  const auto side = [](std::optional<std::int64_t> pixels) {
    return pixels ? std::optional(static_cast<int>(*pixels)) : std::nullopt;
  };
  TourFile file;
  file.id = row.id<TourFileId>();
  file.tour_id = row.id<NamedPartId>();
  file.name = row.text();
  file.media_type = row.text();
  file.bytes = static_cast<std::uint64_t>(row.integer());
  file.sha256 = row.text();
  file.width = side(row.optional_integer());
  file.height = side(row.optional_integer());
  return file;
}

Result<void> check_room(PgConnection& connection, NamedPartId tour_id, std::int64_t more_bytes) {
  auto used = STRATA_TRY(
      connection.query("SELECT count(*), coalesce(sum(b.bytes), 0)::bigint FROM tour_files f "
                       "JOIN blobs b USING (sha256) WHERE f.tour_id = $1",
                       Params().id(tour_id)));
  if (used.integer(0, 0) >= TourFiles::kMaxFiles)
    return fail(ErrorCode::conflict, "Too many files",
                "A tour can have at most " + std::to_string(TourFiles::kMaxFiles) +
                    " files. Remove some files from the tour. The server deletes files that the "
                    "tour has not used for a day.");
  if (used.integer(0, 1) + more_bytes > TourFiles::kMaxBytes)
    return fail(ErrorCode::conflict, "Files too large",
                "The files of a tour can be at most " + std::to_string(TourFiles::kMaxBytes >> 20) +
                    " MiB large in total. Reduce your videos, or use fewer of them. The server "
                    "deletes files that the tour has not used for a day.");
  return {};
}

}  // namespace

Result<TourFile> TourFiles::add(NamedPartId tour_id, const NewTourFile& file,
                                const std::string& user,
                                const IdempotentResponse<TourFile>& answer) {
  STRATA_TRY(check_text(user, "user"));
  STRATA_TRY(check_name(file.name));
  Content content = STRATA_TRY(content_of(file.file, {}));
  STRATA_TRY(blobs_.upload(content));
  const auto work = [&](PgConnection& connection) -> Result<TourFile> {
    STRATA_TRY(keep_blob(connection, content, {}));
    // Lock the tour, so that concurrent transactions cannot exceed the limits together.
    auto tour = STRATA_TRY(connection.query("SELECT 1 FROM tours WHERE id = $1 FOR NO KEY UPDATE",
                                            Params().id(tour_id)));
    if (tour.rows() == 0) return no_such("tour", to_string(tour_id));
    STRATA_TRY(check_room(connection, tour_id, content.bytes));
    auto made = STRATA_TRY(connection.query(
        "INSERT INTO tour_files (tour_id, sha256, name, media_type, width, height, user_name) "
        "VALUES ($1, $2, $3, $4, $5, $6, $7) RETURNING id",
        Params()
            .id(tour_id)
            .bytes(content.hash)
            .text(file.name)
            .text(file.media_type)
            .optional_integer(file.width)
            .optional_integer(file.height)
            .text(user)));
    auto row = STRATA_TRY(connection.query(sql(kTourFiles, "WHERE f.id = $1"),
                                           Params().id(made.id<TourFileId>(0, 0))));
    return read_tour_file(row, 0);
  };
  return change(pool_, answer, work, kBulkLimits);
}

Result<std::vector<TourFile>> TourFiles::of_tour(NamedPartId tour_id) {
  return pool_.read([&](PgConnection& connection) -> Result<std::vector<TourFile>> {
    auto rows = STRATA_TRY(connection.query(sql(kTourFiles, "WHERE f.tour_id = $1 ORDER BY f.id"),
                                            Params().id(tour_id)));
    std::vector<TourFile> files;
    for (int i = 0; i < rows.rows(); ++i) files.push_back(read_tour_file(rows, i));
    return files;
  });
}

Result<TourFile> TourFiles::find(NamedPartId tour_id, TourFileId id) {
  return pool_.read([&](PgConnection& connection) -> Result<TourFile> {
    auto row = STRATA_TRY(connection.query(sql(kTourFiles, "WHERE f.tour_id = $1 AND f.id = $2"),
                                           Params().id(tour_id).id(id)));
    if (row.rows() == 0) return no_such("file", to_string(id));
    return read_tour_file(row, 0);
  });
}

Result<void> TourFiles::drop_unused(NamedPartId tour_id, const std::set<TourFileId>& used,
                                    std::chrono::seconds age) {
  return pool_.write([&](PgConnection& connection) -> Result<void> {
    PgArray kept(oid::kInt8);
    for (const TourFileId id : used) kept.add(id);
    auto gone = STRATA_TRY(
        connection.query("DELETE FROM tour_files WHERE tour_id = $1 AND NOT id = any($2) "
                         "AND time < now() - make_interval(secs => $3) RETURNING sha256",
                         Params().id(tour_id).array(kept).integer(age.count())));
    if (gone.rows() == 0) return {};
    std::vector<std::vector<std::uint8_t>> hashes;
    for (int i = 0; i < gone.rows(); ++i) {
      const Bytes hash = gone.bytes(i, 0);
      hashes.emplace_back(hash.begin(), hash.end());
    }
    return store::drop_unused(connection, hashes);
  });
}

}  // namespace strata::store
