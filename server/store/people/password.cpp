#include "store/people/password.h"

#include <sodium.h>

#include <algorithm>
#include <cctype>
#include <semaphore>
#include <stdexcept>

namespace strata::store {

Result<void> check_password(std::string_view password, std::string_view user,
                            const std::string& field) {
  const auto same = [](char a, char b) {
    return std::tolower(static_cast<unsigned char>(a)) ==
           std::tolower(static_cast<unsigned char>(b));
  };
  if (password.size() > kMaxPasswordLength)
    return fail(ErrorCode::invalid, "Password too long",
                "A password can have at most " + std::to_string(kMaxPasswordLength) +
                    " bytes. Choose a shorter password.",
                field);
  const auto characters =
      std::ranges::count_if(password, [](char c) { return (c & 0xc0) != 0x80; });
  if (static_cast<std::size_t>(characters) < kMinPasswordLength)
    return fail(ErrorCode::invalid, "Password too short",
                "A password must be at least " + std::to_string(kMinPasswordLength) +
                    " characters long. Use several words that nobody can guess.",
                field);
  if (std::ranges::search(password, user, same).size() > 0 &&
      password.size() < user.size() + kMinPasswordLength)
    return fail(ErrorCode::invalid, "Password too simple",
                "The password consists of your user name and only a few other characters, so it is "
                "easy to guess. Choose another password.",
                field);
  return {};
}

namespace {

std::counting_semaphore<2> free_slots{2};  // each hash needs 64 MiB and one core

struct Slot {
  const bool is_had = free_slots.try_acquire_for(std::chrono::seconds(2));
  ~Slot() {
    if (is_had) free_slots.release();
  }
};

tl::unexpected<Error> too_many() {
  return fail(ErrorCode::too_many_requests, "Too many sign-ins",
              "Many people are signing in at the moment. Wait a few seconds and try again.");
}

std::string hash_of(std::string_view password) {
  char hash[crypto_pwhash_STRBYTES];
  if (sodium_init() < 0 ||
      crypto_pwhash_str_alg(hash, password.data(), password.size(),
                            crypto_pwhash_OPSLIMIT_INTERACTIVE, crypto_pwhash_MEMLIMIT_INTERACTIVE,
                            crypto_pwhash_ALG_ARGON2ID13) != 0)
    throw std::runtime_error("no memory to hash a password");
  return hash;
}

}  // namespace

Result<std::string> hash_password(std::string_view password) {
  const Slot slot;
  if (!slot.is_had) return too_many();
  return hash_of(password);
}

Result<bool> password_fits(const std::string& hash, std::string_view password) {
  const Slot slot;
  if (!slot.is_had) return too_many();
  static const std::string nobodys = hash_of("a password that nobody has");
  const std::string& against = hash.empty() ? nobodys : hash;
  return crypto_pwhash_str_verify(against.c_str(), password.data(), password.size()) == 0 &&
         !hash.empty();
}

}  // namespace strata::store
