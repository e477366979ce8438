#include "scene/output_fields.h"

#include "core/error.h"
#include "scene/suggest.h"

#include <fmt/format.h>

#include <algorithm>

namespace spindrift {

const std::vector<std::string>& fieldNames() {
    static const std::vector<std::string> names = {"velocity", "acceleration", "density",
                                                   "pressure", "mass",         "fluid"};
    return names;
}

std::vector<std::string> fieldsOf(const std::string& text) {
    std::vector<std::string> fields;
    std::string words = text;
    std::replace(words.begin(), words.end(), ',', ' ');
    for (size_t at = 0; (at = words.find_first_not_of(' ', at)) != std::string::npos;) {
        const size_t end = std::min(words.find(' ', at), words.size());
        fields.push_back(words.substr(at, end - at));
        at = end;
        const std::vector<std::string>& known = fieldNames();
        if (std::find(known.begin(), known.end(), fields.back()) == known.end())
            throw Error(Failure::Scene,
                        fmt::format("output.fields: there is no \"{}\"; it may list {}",
                                    fields.back(), listed(known)));
    }
    return fields;
}

}  // namespace spindrift
