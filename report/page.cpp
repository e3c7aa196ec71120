// SPDX-License-Identifier: Apache-2.0
#include "report/page.h"

#include "core/base/error.h"
#include "core/image/atomic_file.h"
#include "report/style.h"

#include <system_error>

namespace fieldcast::report {

Markup table(const Table& table) {
    Markup titles;
    for (const std::string& title : table.titles) {
        titles += Markup{joined({"<th scope=\"col\">", escaped(title), "</th>"})};
    }
    Markup rows;
    for (std::size_t i = 0; i < table.rows.size(); ++i) {
        std::string cells;
        for (std::size_t k = 0; k < table.rows[i].size(); ++k) {
            const std::string cell = escaped(table.rows[i][k]);
            cells += k == 0 ? joined({"<th scope=\"row\">", cell, "</th>"}) : joined({"<td>", cell, "</td>"});
        }
        rows += element("tr", i == table.highlighted ? "ours" : "", {cells});
    }
    Markup content = element("thead", "", element("tr", "", titles));
    content += element("tbody", "", rows);
    return element("div", "scroll", element("table", "numbers", content));
}

Markup definitions(const std::vector<std::pair<std::string, std::string>>& entries) {
    Markup list;
    for (const auto& [name, meaning] : entries) {
        list += element("dt", "", text(name));
        list += element("dd", "", text(meaning));
    }
    return element("dl", "", list);
}

Markup paragraph(const std::string& content) {
    return element("p", "", text(content));
}

Markup side_by_side(const std::vector<Markup>& figures) {
    Markup content;
    for (const Markup& figure : figures) {
        content += figure;
    }
    return element("div", "beside", content);
}

Page::Page(std::string title, std::string lead) : title_(std::move(title)), lead_(std::move(lead)) {}

void Page::add_section(const std::string& heading, const Markup& content) {
    Markup section = element("h2", "", text(heading));
    section += content;
    content_ += element("section", "", section);
}

std::string Page::html() const {
    Markup header = element("h1", "", text(title_));
    header += element("p", "lead", text(lead_));
    std::string html = "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
                       "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
                       "<meta name=\"color-scheme\" content=\"light dark\">\n";
    html += joined({"<title>", escaped(title_), "</title>\n<style>\n"});
    html += kStyle;
    html += style_;
    html += "</style>\n</head>\n<body>\n<main>\n";
    html += element("header", "", header).html;
    html += content_.html;
    html += "</main>\n</body>\n</html>\n";
    return html;
}

void Page::write(const std::string& file) const {
    const std::string content = html();
    try {
        image::write_file_atomically(file, std::as_bytes(std::span(content)));
    } catch (const std::system_error& error) {
        throw UserError(file + ": cannot be written: " + error.code().message());
    }
}

} // namespace fieldcast::report
