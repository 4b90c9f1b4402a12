// Whether the interface has to be drawn again: Dear ImGui without a window.
#include "engine/viewer/interface_content.h"

#include <catch2/catch.hpp>
#include <imgui.h>

#include <string>

using namespace splice;

namespace {

// A context of 400 x 300 with a panel of 100 x 300 at the left.
class Panels {
  public:
    Panels() {
        ImGui::CreateContext();
        ImGuiIO& io = ImGui::GetIO();
        io.IniFilename = nullptr;
        io.DisplaySize = {400, 300};
        io.DeltaTime = 0.02F;
        ImGui::GetStyle().WindowBorderSize = 0;  // its smoothed edge reaches beyond the window
        unsigned char* texels = nullptr;
        int width = 0, height = 0;
        io.Fonts->GetTexDataAsAlpha8(&texels, &width, &height);
        // A window's first frame finds its size.
        draw("");
        draw("");
    }
    ~Panels() { ImGui::DestroyContext(); }
    Panels(const Panels&) = delete;
    Panels& operator=(const Panels&) = delete;

    void draw(const std::string& text, bool beside = false) {
        ImGui::NewFrame();
        ImGui::SetNextWindowPos({0, 0});
        ImGui::SetNextWindowSize({100, 300});
        ImGui::Begin("panel", nullptr, ImGuiWindowFlags_NoDecoration);
        ImGui::TextUnformatted(text.c_str());
        ImGui::TextUnformatted("longer than the panel is wide, by far");
        ImGui::End();
        if (beside) ImGui::GetBackgroundDrawList()->AddText({200, 100}, IM_COL32_WHITE, "hint");
        ImGui::Render();
        content.take();
    }

    InterfaceContent content;
    const std::vector<PixelRect> part{{0, 0, 100, 300}};
};

}  // namespace

TEST_CASE("an interface that looks the same has the same revision, one that does not another") {
    Panels panels;
    panels.draw("12 ms");
    const std::uint64_t first = panels.content.revision();
    panels.draw("12 ms");
    CHECK(panels.content.revision() == first);
    panels.draw("13 ms");
    const std::uint64_t second = panels.content.revision();
    CHECK(second != first);
    panels.draw("13 ms");
    CHECK(panels.content.revision() == second);
    ImGui::GetStyle().Colors[ImGuiCol_Text] = {1, 0, 0, 1};
    panels.draw("13 ms");
    CHECK(panels.content.revision() != second);
}

TEST_CASE("what is drawn beside the panels is seen, what they clip is not") {
    Panels panels;
    panels.draw("12 ms");
    CHECK(panels.content.within(panels.part));
    panels.draw("12 ms", true);
    CHECK_FALSE(panels.content.within(panels.part));
    panels.draw("12 ms");
    CHECK(panels.content.within(panels.part));
    CHECK_FALSE(panels.content.within(std::vector<PixelRect>{{0, 0, 99, 300}}));
    CHECK_FALSE(panels.content.within(std::vector<PixelRect>{}));
}
