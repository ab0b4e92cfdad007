#include "window/messages.h"

#include <fmt/format.h>
#include <poll.h>
#include <sys/socket.h>

#include <algorithm>
#include <cerrno>
#include <cmath>

#include "api/error.h"
#include "results/json.h"
#include "scenario/camera_string.h"

namespace lodbench::window {
namespace {

constexpr std::size_t kLongestMessage = 1 << 17;

Json::Value size_json(const Viewport& size) {
    Json::Value json = Json::arrayValue;
    json.append(size.width);
    json.append(size.height);
    return json;
}

Camera camera_of(const Json::Value& text, const Viewport& size) {
    Camera camera = scenario::parse_camera(text.asString(), "message");
    camera.viewport = size;
    return camera;
}

std::optional<std::uint64_t> count_of(const Json::Value& json) {
    if (json.isNull()) return std::nullopt;
    return json.asUInt64();
}

Json::Value count_json(const std::optional<std::uint64_t>& count) {
    return count ? Json::Value(Json::UInt64(*count)) : Json::Value();
}

}  // namespace

const char* name_of(Style style) {
    constexpr const char* kNames[] = {"shaded", "error heat map", "cracks", "colours by level"};
    return kNames[std::size_t(style)];
}

Style next(Style style) {
    return style == Style::levels ? Style::shaded : Style(int(style) + 1);
}

int level_of(double longest_edge, double cell_diagonal) {
    return std::max(0, int(std::lround(std::log2(longest_edge / cell_diagonal))));
}

bool operator==(const PictureRequest& a, const PictureRequest& b) {
    return to_json(a) == to_json(b);
}

Json::Value to_json(const PictureRequest& request) {
    Json::Value json;
    json["do"] = "picture";
    json["selected"] = scenario::camera_string(request.selected);
    json["view"] = scenario::camera_string(request.view);
    json["size"] = size_json(request.selected.viewport);
    json["frame"] = Json::Int64(request.frame);
    json["frozen"] = request.frozen;
    json["wireframe"] = request.wireframe;
    json["style"] = int(request.style);
    json["scale_px"] = request.scale_px;
    return json;
}

PictureRequest picture_request(const Json::Value& json) {
    const Viewport size{json["size"][0].asInt(), json["size"][1].asInt()};
    if (size.width < 1 || size.height < 1 || size.width > kLargestSide ||
        size.height > kLargestSide) {
        throw InputError(fmt::format("a picture of {} x {} pixels: each side has 1 to {}",
                                     size.width, size.height, kLargestSide));
    }
    PictureRequest request;
    request.selected = camera_of(json["selected"], size);
    request.view = camera_of(json["view"], size);
    request.frame = json["frame"].asInt64();
    request.frozen = json["frozen"].asBool();
    request.wireframe = json["wireframe"].asBool();
    request.style = Style(std::clamp(json["style"].asInt(), 0, int(Style::levels)));
    request.scale_px = json["scale_px"].asDouble();
    return request;
}

Json::Value to_json(const PictureReply& reply) {
    Json::Value json;
    json["did"] = "picture";
    json["width"] = reply.width;
    json["height"] = reply.height;
    json["select_ms"] = reply.select_ms;
    json["submit_ms"] = reply.submit_ms;
    json["wall_ms"] = reply.wall_ms;
    json["gpu_ms"] = results::number(reply.gpu_ms);
    json["triangles"] = Json::UInt64(reply.triangles);
    json["draw_calls"] = Json::UInt64(reply.draw_calls);
    json["uploaded_bytes"] = Json::UInt64(reply.uploaded_bytes);
    json["gpu_bytes"] = Json::UInt64(reply.gpu_bytes);
    json["pixel_max_px"] = results::number_or_inf(reply.pixel_max_px);
    json["pixel_p999_px"] = results::number_or_inf(reply.pixel_p999_px);
    json["pixel_rms_px"] = results::number_or_inf(reply.pixel_rms_px);
    json["crack_pixels"] = count_json(reply.crack_pixels);
    return json;
}

PictureReply picture_reply(const Json::Value& json) {
    PictureReply reply;
    reply.width = json["width"].asInt();
    reply.height = json["height"].asInt();
    reply.select_ms = json["select_ms"].asDouble();
    reply.submit_ms = json["submit_ms"].asDouble();
    reply.wall_ms = json["wall_ms"].asDouble();
    reply.gpu_ms = results::read_number_or_inf(json["gpu_ms"]);
    reply.triangles = json["triangles"].asUInt64();
    reply.draw_calls = json["draw_calls"].asUInt64();
    reply.uploaded_bytes = json["uploaded_bytes"].asUInt64();
    reply.gpu_bytes = json["gpu_bytes"].asUInt64();
    reply.pixel_max_px = results::read_number_or_inf(json["pixel_max_px"]);
    reply.pixel_p999_px = results::read_number_or_inf(json["pixel_p999_px"]);
    reply.pixel_rms_px = results::read_number_or_inf(json["pixel_rms_px"]);
    reply.crack_pixels = count_of(json["crack_pixels"]);
    return reply;
}

Json::Value to_json(const ProbeReply& reply) {
    Json::Value json;
    json["did"] = "probe";
    json["hit"] = reply.hit;
    json["row"] = reply.row;
    json["column"] = reply.column;
    json["x"] = reply.x;
    json["y"] = reply.y;
    json["true_low"] = reply.true_low;
    json["true_high"] = reply.true_high;
    json["drawn"] = results::number(reply.drawn);
    json["error_px"] = results::number_or_inf(reply.error_px);
    json["error_m"] = results::number(reply.error_m);
    json["level"] = reply.level ? Json::Value(*reply.level) : Json::Value();
    return json;
}

ProbeReply probe_reply(const Json::Value& json) {
    ProbeReply reply;
    reply.hit = json["hit"].asBool();
    reply.row = json["row"].asInt();
    reply.column = json["column"].asInt();
    reply.x = json["x"].asDouble();
    reply.y = json["y"].asDouble();
    reply.true_low = json["true_low"].asDouble();
    reply.true_high = json["true_high"].asDouble();
    reply.drawn = results::read_number_or_inf(json["drawn"]);
    reply.error_px = results::read_number_or_inf(json["error_px"]);
    reply.error_m = results::read_number_or_inf(json["error_m"]);
    if (!json["level"].isNull()) reply.level = json["level"].asInt();
    return reply;
}

bool send_message(int socket, const Json::Value& message) {
    const std::string text = results::exact_text(message);
    ssize_t sent = 0;
    do {
        sent = send(socket, text.data(), text.size(), MSG_NOSIGNAL);
    } while (sent < 0 && errno == EINTR);
    return sent == ssize_t(text.size());
}

std::optional<Json::Value> receive_message(int socket) {
    std::string text(kLongestMessage, '\0');
    ssize_t count = 0;
    do {
        count = recv(socket, text.data(), text.size(), 0);
    } while (count < 0 && errno == EINTR);
    if (count <= 0) return std::nullopt;
    text.resize(std::size_t(count));
    try {
        return results::parse_json(text, "message");
    } catch (const Json::Exception& error) {
        throw InputError(fmt::format("message: {}", error.what()));
    }
}

}  // namespace lodbench::window
