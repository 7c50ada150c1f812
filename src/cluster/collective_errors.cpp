// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <exception>
#include <iterator>
#include <new>
#include <sstream>

#include "pellucid/cluster/render.h"
#include "pellucid/io/internal/checksum.h"
#include "pellucid/scene/error.h"
#include "rank_work.h"

namespace pellucid {
namespace {

// The first letter of what a rank tells of its work.
constexpr char done = 'd', failed = 'f', cancelled = 'c';

}  // namespace

std::string outcome_of(const std::function<void()>& work) {
  try {
    work();
    return {done};
  } catch (const Cancelled&) {
    return {cancelled};
  } catch (const std::bad_alloc&) {
    return failed + std::string("not enough memory; use more ranks, or fewer on each machine");
  } catch (const std::exception& e) {
    return failed + std::string(e.what());
  }
}

bool is_done(const std::string& outcome) noexcept {
  return !outcome.empty() && outcome[0] == done;
}

void throw_unless_done(const std::vector<std::string>& outcomes) {
  // A rank that fails cancels the others.
  for (std::size_t i = 0; i < outcomes.size(); ++i) {
    if (outcomes[i].empty() || outcomes[i][0] != failed) continue;
    const std::string rank = outcomes.size() > 1 ? "rank " + std::to_string(i) + ": " : "";
    throw AgreedError(rank + outcomes[i].substr(1));
  }
  for (const std::string& outcome : outcomes) {
    if (!is_done(outcome)) throw Cancelled();
  }
}

void agreed(Communicator& ranks, const std::function<void()>& work) {
  throw_unless_done(ranks.gather_all(outcome_of(work)));
}

void check_equal(Communicator& ranks, const std::string& what, const std::string& own) {
  check_equal(ranks, {{what, own}});
}

void check_equal(Communicator& ranks, const std::vector<std::pair<std::string, std::string>>& own) {
  std::string lines;
  for (const auto& [what, text] : own) lines += text + '\n';
  Checksum sum;
  sum.add(lines);
  const std::vector<std::string> sums = ranks.gather_all(std::to_string(sum.value()));
  if (std::ranges::count(sums, sums[0]) == std::ssize(sums)) return;
  const std::vector<std::string> all = ranks.gather_all(lines);
  std::vector<std::istringstream> of_rank(all.begin(), all.end());
  for (const auto& [what, text] : own) {
    std::string first, line;
    std::getline(of_rank[0], first);
    for (std::size_t i = 1; i < all.size(); ++i) {
      line.clear();
      std::getline(of_rank[i], line);
      if (line == first) continue;
      throw AgreedError("rank " + std::to_string(i) + ": " + what + " is " + line +
                        ", but that of rank 0 is " + first + "; start all ranks with the same");
    }
  }
}

}  // namespace pellucid
