#include "store/content/answers.h"
#include "store/store_impl.h"

namespace strata::store {
namespace {

Result<void> check_key(const std::string& key) {
  if (key.empty() || key.size() > kMaxNameLength)
    return fail(ErrorCode::malformed, "Invalid Idempotency-Key",
                "An Idempotency-Key must be 1 to 255 bytes long.", "Idempotency-Key");
  return check_text(key, "Idempotency-Key");
}

}  // namespace

Result<std::optional<nlohmann::json>> Answers::find(const std::string& key) {
  STRATA_TRY(check_key(key));
  return pool_.read([&](PgConnection& connection) -> Result<std::optional<nlohmann::json>> {
    auto row = STRATA_TRY(connection.query(
        "SELECT answer FROM answers WHERE key = $1 AND time > now() - interval '7 days'",
        Params().text(key)));
    if (row.rows() == 0) return std::optional<nlohmann::json>();
    STRATA_TRY(connection.confirm_visible());
    return std::optional<nlohmann::json>(row.json(0, 0));
  });
}

// Deletes some expired responses first. Another server may do the same, so each server skips the
// rows that the other has locked.
Result<void> insert_answer(PgConnection& connection, const std::string& key,
                           const nlohmann::json& answer) {
  STRATA_TRY(check_key(key));
  STRATA_TRY(check_json(answer, "answer"));
  STRATA_TRY(connection.query(
      "DELETE FROM answers WHERE key IN (SELECT key FROM answers "
      "WHERE time <= now() - interval '7 days' LIMIT 1000 FOR UPDATE SKIP LOCKED)"));
  auto inserted = STRATA_TRY(
      connection.query("INSERT INTO answers (key, answer) VALUES ($1, $2) "
                       "ON CONFLICT (key) DO UPDATE SET answer = excluded.answer, time = now() "
                       "WHERE answers.time <= now() - interval '7 days'",
                       Params().text(key).json(answer)));
  if (inserted.affected() == 0)
    return fail(ErrorCode::conflict, "Duplicate request",
                "Another request with this Idempotency-Key was completed first. Send the request "
                "again to get its response.",
                "Idempotency-Key");
  return {};
}

}  // namespace strata::store
