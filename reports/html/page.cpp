#include "reports/html/page.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <kainjow/mustache.hpp>
#include <map>
#include <set>

#include "reports/escape.hpp"
#include "reports/html/caveats.hpp"
#include "reports/html/csp_hash.hpp"
#include "reports/html/page_parts.hpp"
#include "reports/html/reproduce.hpp"
#include "reports/html/verdict.hpp"
#include "reports/tables/writers.hpp"
#include "slam/core/counted.hpp"

namespace corridor::html {
namespace {

namespace fs = std::filesystem;
using kainjow::mustache::data;
using reports::Case;
using reports::Cases;

// Longer tables are folded.
constexpr std::size_t kMaxOpenRows = 24;

// Farther away from the page than this, a folder is named without its place.
constexpr std::ptrdiff_t kMaxStepsUp = 2;

// Relative to the page where the file system allows it.
std::string link_to(const fs::path& target, const fs::path& out) {
  std::error_code error;
  const fs::path relative = fs::relative(target, out, error);
  return reports::url_from_path((error || relative.empty() ? target : relative).string());
}

data text_item(const std::string& text) {
  return data(kainjow::mustache::object{{"text", reports::valid_utf8(text)}});
}

template <class Items>
data text_list(const Items& items) {
  data list(data::type::list);
  for (const std::string& item : items) list.push_back(text_item(item));
  return list;
}

std::string file_links(const std::string& folder, const std::string& stem,
                       std::initializer_list<const char*> suffixes) {
  std::string links;
  for (const char* suffix : suffixes) {
    const std::string name = fmt::format("{}.{}", reports::file_name_from(stem), suffix);
    links += fmt::format("{}<a href=\"{}/{}\">{}</a>", links.empty() ? "" : " ", folder,
                         reports::url_from_path(name), suffix);
  }
  return fmt::format("<span class=\"note\">As files: {}</span>", links);
}

data verdict_list(const Cases& cases) {
  data list(data::type::list);
  for (const Verdict& verdict : verdicts(cases)) {
    data item;
    item.set("subject", reports::valid_utf8(verdict.subject));
    item.set("sentences", text_list(verdict.sentences));
    item.set("has_details", !verdict.details.empty());
    item.set("details", text_list(verdict.details));
    list.push_back(item);
  }
  return list;
}

data table_list(const std::vector<tables::Table>& all,
                std::string (*to_html)(const tables::Table&)) {
  data list(data::type::list);
  for (const tables::Table& table : all) {
    data item;
    item.set("caption", table.caption);
    item.set("html", to_html(table));
    item.set("links", file_links("tables", table.id, {"csv", "md", "tex"}));
    item.set("is_folded", table.is_detail || table.rows.size() > kMaxOpenRows);
    item.set("num_rows", fmt::format("{}", table.rows.size()));
    list.push_back(item);
  }
  return list;
}

data figure_list(const std::vector<figures::Figure>& all) {
  data list(data::type::list);
  for (const figures::Figure& figure : all) {
    data item;
    item.set("title", reports::valid_utf8(figure.svg.title()));
    item.set("svg", figure.svg.element());
    item.set("caption", reports::valid_utf8(figure.caption));
    item.set("links", file_links("figures", figure.svg.id(), {"svg", "png"}));
    list.push_back(item);
  }
  return list;
}

data machine_list(const Cases& cases) {
  std::set<std::string> unknown;
  for (const Case& entry : cases.all()) unknown.insert(entry.result.machine_id);
  data list(data::type::list);
  const auto add = [&](const std::string& id, const std::string& text) {
    data item;
    item.set("id", reports::valid_utf8(id));
    item.set("text", reports::valid_utf8(text));
    list.push_back(item);
  };
  for (const results::Machine& machine : cases.machines()) {
    unknown.erase(machine.machine_id);
    add(machine.machine_id,
        fmt::format("{}, {} cores, {} MiB, {}{}, {}", machine.cpu_model, machine.num_cores,
                    machine.memory_mib, machine.kernel.starts_with("Linux") ? "" : "Linux ",
                    machine.kernel, machine.compiler));
  }
  for (const std::string& id : unknown) add(id, "not described in the store");
  return list;
}

data parameter_list(const Cases& cases) {
  std::map<std::pair<std::string, std::string>, const Case*> by_hash;
  for (const Case& entry : cases.all()) {
    by_hash.emplace(
        std::make_pair(cases.label(reports::series_of(entry.result)), entry.result.parameters_hash),
        &entry);
  }
  data list(data::type::list);
  for (const auto& [key, entry] : by_hash) {
    data rows(data::type::list);
    for (const auto& [name, value] : entry->result.parameters) {
      data row;
      row.set("name", reports::valid_utf8(name));
      row.set("value", reports::valid_utf8(value));
      rows.push_back(row);
    }
    data item;
    item.set("label", reports::valid_utf8(key.first));
    item.set("hash", reports::valid_utf8(key.second));
    item.set("rows", rows);
    list.push_back(item);
  }
  return list;
}

data case_list(const Cases& cases, const fs::path& out) {
  data list(data::type::list);
  for (const Case& entry : cases.all()) {
    data item;
    item.set("url", link_to(entry.dir / "result.json", out));
    item.set("id", reports::valid_utf8(entry.result.case_id));
    item.set("dataset", reports::valid_utf8(entry.result.dataset));
    item.set("label", reports::valid_utf8(cases.label(reports::series_of(entry.result))));
    item.set("status", results::to_text(entry.result.status));
    list.push_back(item);
  }
  return list;
}

// Where the store lies as seen from the page; whose disk it is on is nobody's business.
std::string store_name(const fs::path& run_dir, const fs::path& out) {
  std::error_code error;
  const fs::path relative = fs::relative(run_dir / "results.sqlite", out, error);
  const auto num_up = std::count(relative.begin(), relative.end(), fs::path(".."));
  if (!error && !relative.empty() && num_up <= kMaxStepsUp) return relative.string();
  return (run_dir.lexically_normal().filename() / "results.sqlite").string();
}

data store_list(const Cases& cases, const fs::path& out) {
  data list(data::type::list);
  for (const fs::path& run_dir : cases.run_dirs()) {
    data item;
    item.set("url", link_to(run_dir / "results.sqlite", out));
    item.set("text", reports::valid_utf8(store_name(run_dir, out)));
    list.push_back(item);
  }
  return list;
}

std::set<std::string> suites(const Cases& cases) {
  std::set<std::string> names;
  for (const Case& entry : cases.all()) names.insert(entry.result.suite);
  names.erase("");
  return names;
}

std::set<std::string> revisions(const Cases& cases) {
  std::set<std::string> names;
  for (const Case& entry : cases.all()) names.insert(entry.result.git_revision);
  return names;
}

std::string subtitle(const Cases& cases) {
  std::set<std::string> systems;
  for (const Case& entry : cases.all()) systems.insert(entry.result.system);
  const std::size_t num_series = cases.series().size();
  return fmt::format("{}: {}{} on {}", counted(cases.all().size(), "case"),
                     counted(systems.size(), "system"),
                     num_series == systems.size() ? "" : fmt::format(" in {} variants", num_series),
                     counted(cases.datasets().size(), "data set"));
}

}  // namespace

Result<std::string> render_page(const PageContent& content) {
  const Cases& cases = *content.cases;
  const std::string style = std::string(kPageCss) + figures::figure_css();
  data page;
  page.set("title", reports::valid_utf8(fmt::format("Corridor Bench report{}{}",
                                                    suites(cases).empty() ? "" : ": ",
                                                    fmt::join(suites(cases), ", "))));
  page.set("subtitle", subtitle(cases));
  page.set("style", style);
  page.set("style_hash", csp_hash(style));
  page.set("verdicts", verdict_list(cases));
  page.set("tables", table_list(*content.tables, tables::to_html));
  page.set("has_figures", !content.figures->empty());
  page.set("figures", figure_list(*content.figures));
  page.set("revisions", text_list(revisions(cases)));
  page.set("machines", machine_list(cases));
  page.set("seeds", seed_text(cases));
  page.set("caveats", text_list(caveats(cases)));
  page.set("parameters", parameter_list(cases));
  page.set("commands", reports::valid_utf8(reproduce_commands(cases)));
  page.set("stores", store_list(cases, content.out));
  page.set("num_cases", fmt::format("{}", cases.all().size()));
  page.set("case_files", case_list(cases, content.out));
  page.set("has_problems", !content.problems->empty());
  page.set("problems", text_list(*content.problems));
  kainjow::mustache::mustache shell{std::string(kPageTemplate)};
  if (!shell.is_valid()) {
    return fail(ErrorCode::kInternal, "the page template is broken: " + shell.error_message());
  }
  return shell.render(page);
}

}  // namespace corridor::html
