// Whether a page is well-formed: enough of XML for what the benchmark writes.
#pragma once

#include <map>
#include <string>
#include <string_view>

namespace splice::test {

struct MarkupCheck {
    std::string problem;                  ///< empty: well-formed
    std::map<std::string, int> elements;  ///< how often each occurs
};

/// Tags nest and close, attributes are quoted, and text has no bare & or <.
MarkupCheck check_markup(std::string_view text);

}  // namespace splice::test
