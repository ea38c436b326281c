// The memory of a run as one table: who needs how much, measured by running the same bind() functions that
// later take it, so that the plan cannot differ from what is used.
#pragma once

#include <cstddef>
#include <cstdio>

#include "algo/core/bump.hpp"
#include "algo/core/fixed_vector.hpp"

namespace st {

// A row whose memory a member function of its owner takes.
template <typename Owner>
struct MemberPart {
  Owner* owner;
  void (Owner::*take)(Bump&);
  void bind(Bump& memory) { (owner->*take)(memory); }
};

class MemoryPlan {
 public:
  static constexpr std::size_t kMaxEntries = 48;

  struct Entry {
    const char* name = "";   // what it is, for people
    const char* owner = "";  // the folder whose code uses it
    std::size_t bytes = 0;
    void* part = nullptr;
    void (*bind)(void* part, Bump& bump) = nullptr;
  };

  // Adds `part`, whose bind(Bump&) takes its memory, and measures it. `part`, `name` and `owner` must outlive
  // the plan. Throws Failure once the plan is sealed or the table is full.
  template <typename Part>
  void add(const char* name, const char* owner, Part& part) {
    add_entry({name, owner, 0, &part, [](void* p, Bump& bump) { static_cast<Part*>(p)->bind(bump); }});
  }

  const FixedVector<Entry, kMaxEntries>& entries() const { return entries_; }
  std::size_t bytes() const { return bytes_; }  // of all entries, alignment included

  // Runs every bind() over `memory`. After this nothing can be added. Throws Failure when the memory is too
  // small or a part took another amount than it was measured with.
  void seal(Bump memory);
  bool sealed() const { return sealed_; }

  void print(std::FILE* out) const;

 private:
  void add_entry(Entry entry);

  FixedVector<Entry, kMaxEntries> entries_;
  std::size_t bytes_ = 0;
  bool sealed_ = false;
};

}  // namespace st
