// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "report/markup.h"

#include <utility>
#include <vector>

namespace fieldcast::report {

/// A table: first column names, the others numbers.
struct Table {
    std::vector<std::string> titles;
    std::vector<std::vector<std::string>> rows;
    std::size_t highlighted = ~std::size_t{0}; ///< emphasised row
};
Markup table(const Table& table);

/// A list of names and their meanings.
Markup definitions(const std::vector<std::pair<std::string, std::string>>& entries);

Markup paragraph(const std::string& content);

/// Charts beside each other where there is room.
Markup side_by_side(const std::vector<Markup>& figures);

/// One self-contained HTML file. It loads nothing else, has light and dark colours, and fits screens of any size and
/// paper.
class Page {
public:
    /// `lead`: a summary in one sentence.
    Page(std::string title, std::string lead);

    void add_section(const std::string& heading, const Markup& content);
    /// A style rule that some content needs, such as pictures that are shown in several places.
    void add_style(const std::string& rule) { style_ += rule; }

    std::string html() const;

    /// The file appears complete or not at all. Throws UserError if it cannot be written.
    void write(const std::string& file) const;

private:
    std::string title_;
    std::string lead_;
    std::string style_;
    Markup content_;
};

} // namespace fieldcast::report
