#include "bench/runner/earlier_cases.hpp"

#include <fmt/format.h>

#include <map>
#include <set>

namespace corridor::runner {

Result<EarlierCases> earlier_cases(const results::ResultsStore& store,
                                   const std::vector<CaseSpec>& cases,
                                   const std::filesystem::path& folder) {
  const Result<std::vector<results::RunResult>> records = store.read_all();
  if (!records) return tl::make_unexpected(records.error());
  std::set<std::string> ids;
  std::map<std::string, std::string> digests;
  for (const CaseSpec& spec : cases) {
    ids.insert(case_id(spec));
    digests[spec.dataset] = spec.data_digest;
  }
  EarlierCases earlier;
  std::set<std::string> suites;
  for (const results::RunResult& record : *records) {
    if (ids.contains(record.case_id)) continue;
    ++earlier.num_cases;
    suites.insert(record.suite);
    const auto same_name = digests.find(record.dataset);
    const bool is_known = same_name != digests.end() && !same_name->second.empty() &&
                          record.data_digest && !record.data_digest->empty();
    if (!is_known || same_name->second == *record.data_digest) continue;
    return fail(
        ErrorCode::kInvalid,
        fmt::format(R"(holds results of another data set that is called "{}" too)", record.dataset),
        folder.string(), "another --out, or a log of another name");
  }
  earlier.suites.assign(suites.begin(), suites.end());
  return earlier;
}

}  // namespace corridor::runner
