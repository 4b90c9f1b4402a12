// Which device is chosen, what is said when there is none, and that validation is heard.
#include "engine/vulkan/buffer.h"
#include "engine/vulkan/device.h"
#include "engine/vulkan/device_list.h"
#include "engine/vulkan/timestamps.h"
#include "preprocess/model_format/error.h"

#include <catch2/catch.hpp>

namespace {

using namespace splice;

gpu::DeviceInfo device(uint32_t index, VkPhysicalDeviceType type, const std::string& unusable = "") {
    gpu::DeviceInfo info;
    info.index = index;
    info.name = "device " + std::to_string(index);
    info.type = type;
    info.unusable = unusable;
    return info;
}

constexpr gpu::DeviceChoice kAutomatic{gpu::DeviceChoice::Kind::automatic, 0};
constexpr gpu::DeviceChoice kCpu{gpu::DeviceChoice::Kind::cpu, 0};

}  // namespace

TEST_CASE("a real GPU goes before a software device, a discrete one before an integrated one") {
    const auto cpu = device(0, VK_PHYSICAL_DEVICE_TYPE_CPU);
    const auto integrated = device(1, VK_PHYSICAL_DEVICE_TYPE_INTEGRATED_GPU);
    const auto discrete = device(2, VK_PHYSICAL_DEVICE_TYPE_DISCRETE_GPU);
    const auto other_discrete = device(3, VK_PHYSICAL_DEVICE_TYPE_DISCRETE_GPU);
    CHECK(gpu::choose_device({cpu}, kAutomatic).index == 0);
    CHECK(gpu::choose_device({cpu, integrated}, kAutomatic).index == 1);
    CHECK(gpu::choose_device({cpu, integrated, discrete, other_discrete}, kAutomatic).index == 2);
    CHECK(gpu::choose_device({cpu, integrated, discrete}, kCpu).index == 0);
}

TEST_CASE("a device that cannot run the engine is passed over, and named when it was asked for") {
    const auto old = device(0, VK_PHYSICAL_DEVICE_TYPE_DISCRETE_GPU, "Vulkan 1.1, needs 1.3");
    const auto cpu = device(1, VK_PHYSICAL_DEVICE_TYPE_CPU);
    CHECK(gpu::choose_device({old, cpu}, kAutomatic).index == 1);
    CHECK_THROWS_WITH(gpu::choose_device({old}, kAutomatic),
                      Catch::Contains("Vulkan 1.1, needs 1.3") && Catch::Contains("apt install mesa-vulkan-drivers"));
    CHECK_THROWS_WITH(gpu::choose_device({old, cpu}, {gpu::DeviceChoice::Kind::index, 0}),
                      Catch::Contains("device 0") && Catch::Contains("Vulkan 1.1"));
}

TEST_CASE("without a device the message says how to install one") {
    CHECK_THROWS_AS(gpu::choose_device({}, kAutomatic), DeviceError);
    CHECK_THROWS_WITH(gpu::choose_device({}, kAutomatic), Catch::Contains("apt install mesa-vulkan-drivers"));
    const auto discrete = device(0, VK_PHYSICAL_DEVICE_TYPE_DISCRETE_GPU);
    CHECK_THROWS_WITH(gpu::choose_device({discrete}, kCpu), Catch::Contains("apt install mesa-vulkan-drivers"));
    CHECK_THROWS_WITH(gpu::choose_device({discrete}, {gpu::DeviceChoice::Kind::index, 7}),
                      Catch::Contains("no Vulkan device 7"));
}

TEST_CASE("a device option is auto, cpu or an index") {
    CHECK(gpu::parse_device_choice("auto").kind == gpu::DeviceChoice::Kind::automatic);
    CHECK(gpu::parse_device_choice("cpu").kind == gpu::DeviceChoice::Kind::cpu);
    CHECK(gpu::parse_device_choice("12").index == 12);
    for (const char* wrong : {"", "gpu", "-1", "1x", "99999999999", " 1"}) {
        CHECK_THROWS_AS(gpu::parse_device_choice(wrong), UsageError);
    }
}

TEST_CASE("validation hears a hazard that only synchronisation validation knows") {
    const gpu::Instance instance({.application = "splice tests", .validate = true});
    gpu::Device gpu_device(instance);
    const gpu::Buffer a(gpu_device, {1024, 0, gpu::MemoryUse::device, "a"});
    const gpu::Buffer b(gpu_device, {1024, 0, gpu::MemoryUse::device, "b"});
    CHECK(instance.messages().empty());
    gpu_device.submit_and_wait([&](VkCommandBuffer commands) {
        const VkBufferCopy all{0, 0, 1024};
        vkCmdFillBuffer(commands, a.handle(), 0, VK_WHOLE_SIZE, 1);
        vkCmdCopyBuffer(commands, a.handle(), b.handle(), 1, &all);  // reads what may not be written yet
    });
    REQUIRE(instance.messages().size() == 1);
    CHECK(instance.messages()[0].error);
    CHECK(instance.messages()[0].id == "SYNC-HAZARD-READ-AFTER-WRITE");
}

TEST_CASE("a throwing recorder submits nothing and leaves the device usable") {
    const gpu::Instance instance({.application = "splice tests", .validate = true});
    gpu::Device gpu_device(instance);
    CHECK_THROWS_AS(gpu_device.submit_and_wait([](VkCommandBuffer) { throw Error("stop"); }), Error);
    bool recorded = false;
    gpu_device.submit_and_wait([&](VkCommandBuffer) { recorded = true; });
    CHECK(recorded);
    CHECK(instance.messages().empty());
}

TEST_CASE("timestamps grow from the first one on") {
    const gpu::Instance instance({.application = "splice tests", .validate = true});
    gpu::Device gpu_device(instance);
    if (!gpu_device.features().timestamps) return;
    gpu::Timestamps stamps(gpu_device, 3);
    const gpu::Buffer buffer(gpu_device, {uint64_t{1} << 20, 0, gpu::MemoryUse::device, "a"});
    CHECK(stamps.read_ms().empty());
    gpu_device.submit_and_wait([&](VkCommandBuffer commands) {
        stamps.reset(commands);
        stamps.write(commands);
        vkCmdFillBuffer(commands, buffer.handle(), 0, VK_WHOLE_SIZE, 1);
        stamps.write(commands);
        stamps.write(commands);
        CHECK_THROWS_AS(stamps.write(commands), DeviceError);
    });
    const std::vector<double> times = stamps.read_ms();
    REQUIRE(times.size() == 3);
    CHECK(times[0] == 0);
    CHECK(times[1] >= times[0]);
    CHECK(times[2] >= times[1]);
    CHECK(instance.messages().empty());
}
