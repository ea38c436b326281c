#include "hal/models/sqlite.hpp"

#include <sqlite3.h>

#include "hal/error.hpp"

namespace st {
namespace {

constexpr int kPatience_ms = 5000;

// SQLite's words, with what to do where it is known.
std::string advice(int code) {
  switch (code & 0xff) {
    case SQLITE_NOTADB:
      return "is no model database; name another file with --models (this one was not touched)";
    case SQLITE_CORRUPT:
      return "is damaged; take a backup, or name another file with --models (this one was not touched)";
    case SQLITE_BUSY:
    case SQLITE_LOCKED:
      return "another program has been writing to it for five seconds; try again when it has ended";
    case SQLITE_FULL:
      return "the disk is full; make room and try again";
    case SQLITE_READONLY:
      return "may not be written; check its permissions and its folder's";
    case SQLITE_CANTOPEN:
      return "cannot be opened; check that its folder is there and may be written";
    default:
      return "";
  }
}

}  // namespace

Database::Database(const std::string& path, Access access) : path_(path) {
  const int flags =
      access == Access::kRead ? SQLITE_OPEN_READONLY : SQLITE_OPEN_READWRITE | SQLITE_OPEN_CREATE;
  if (sqlite3_open_v2(path.c_str(), &handle_, flags, nullptr) != SQLITE_OK) {
    const std::string what = advice(SQLITE_CANTOPEN);
    sqlite3_close(handle_);
    throw Failure(ExitCode::kBadInput, path + ": " + what);
  }
  sqlite3_busy_timeout(handle_, kPatience_ms);
}

Database::~Database() { sqlite3_close(handle_); }

void Database::fail() const {
  const std::string what = advice(sqlite3_extended_errcode(handle_));
  throw Failure(ExitCode::kBadInput, path_ + ": " + (what.empty() ? sqlite3_errmsg(handle_) : what));
}

void Database::run(const std::string& sql) {
  if (sqlite3_exec(handle_, sql.c_str(), nullptr, nullptr, nullptr) != SQLITE_OK) fail();
}

std::int64_t Database::number(const std::string& sql) {
  Statement statement(*this, sql);
  return statement.next() ? statement.number_at(0) : 0;
}

std::string Database::text(const std::string& sql) {
  Statement statement(*this, sql);
  return statement.next() ? statement.text_at(0) : std::string();
}

Statement::Statement(const Database& database, std::string_view sql) : database_(database) {
  if (sqlite3_prepare_v2(database.handle(), sql.data(), static_cast<int>(sql.size()), &statement_, nullptr) !=
      SQLITE_OK)
    database.fail();
}

Statement::~Statement() { sqlite3_finalize(statement_); }

Statement& Statement::text(std::string_view value) {
  sqlite3_bind_text(statement_, ++bound_, value.data(), static_cast<int>(value.size()), SQLITE_TRANSIENT);
  return *this;
}

Statement& Statement::blob(std::string_view value) {
  sqlite3_bind_blob64(statement_, ++bound_, value.data(), value.size(), SQLITE_TRANSIENT);
  return *this;
}

Statement& Statement::number(std::int64_t value) {
  sqlite3_bind_int64(statement_, ++bound_, value);
  return *this;
}

Statement& Statement::real(double value) {
  sqlite3_bind_double(statement_, ++bound_, value);
  return *this;
}

bool Statement::next() {
  const int code = sqlite3_step(statement_);
  if (code == SQLITE_ROW) return true;
  if (code != SQLITE_DONE) database_.fail();
  return false;
}

std::string Statement::text_at(int column) const {
  const void* const bytes = sqlite3_column_blob(statement_, column);
  const int length = sqlite3_column_bytes(statement_, column);
  return bytes == nullptr ? std::string()
                          : std::string(static_cast<const char*>(bytes), static_cast<std::size_t>(length));
}

std::int64_t Statement::number_at(int column) const { return sqlite3_column_int64(statement_, column); }

double Statement::real_at(int column) const { return sqlite3_column_double(statement_, column); }

Transaction::~Transaction() {
  if (open_) sqlite3_exec(database_.handle(), "ROLLBACK", nullptr, nullptr, nullptr);
}

void Transaction::commit() {
  database_.run("COMMIT");
  open_ = false;
}

}  // namespace st
