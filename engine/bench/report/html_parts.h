// The parts of the pages that benchmarks write: well-formed XHTML, styled by report_style.h.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace splice::bench {

/// A drawing (svg.h) with a title above.
std::string figure(std::string_view title, std::string_view caption, const std::string& drawing);

/// One figure that matters, and what it should be.
std::string tile(const std::string& value, std::string_view meaning, std::string_view goal, bool reached);

std::string html_table(const std::vector<std::string>& header, const std::vector<std::vector<std::string>>& rows);

/// `body` below the heading; `caption` says what was measured where.
std::string page(std::string_view title, std::string_view caption, const std::string& body);

}  // namespace splice::bench
