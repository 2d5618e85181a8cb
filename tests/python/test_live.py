# SPDX-License-Identifier: Apache-2.0
"""kilolux.show(): the page, its pictures, its end."""
import json
import re
import socket
import struct
import urllib.request

import numpy as np
import pytest

import kilolux


class Page:
    """A page's WebSocket: masked with zeros, messages below 126 bytes or of two more."""

    def __init__(self, address):
        self.host, self.port, self.secret = re.fullmatch(r"http://([\d.]+):(\d+)/#(\w+)", address).groups()
        self.socket = socket.create_connection((self.host, int(self.port)), timeout=120)
        host = f"{self.host}:{self.port}"
        self.socket.sendall(f"GET / HTTP/1.1\r\nHost: {host}\r\nOrigin: http://{host}\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n"
                            "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\nSec-WebSocket-Version: 13\r\n"
                            "Sec-WebSocket-Protocol: kilolux\r\n\r\n".encode())
        self.read = self.socket.makefile("rb")
        assert b"101" in self.read.readline()
        while self.read.readline() != b"\r\n":
            pass

    def send(self, *message):
        text = json.dumps(message).encode()
        size = bytes([0x80 | len(text)]) if len(text) < 126 else struct.pack(">BH", 0x80 | 126, len(text))
        self.socket.sendall(b"\x81" + size + bytes(4) + text)

    def frame(self):
        """(opcode, payload) of the next message."""
        first, size = self.read.read(2)
        if size == 126:
            size, = struct.unpack(">H", self.read.read(2))
        elif size == 127:
            size, = struct.unpack(">Q", self.read.read(8))
        return first & 15, self.read.read(size)

    def picture(self, lossless):
        """The bytes of the next picture of that kind; all are acknowledged."""
        while True:
            opcode, payload = self.frame()
            assert opcode != 8, payload
            if opcode != 2:
                continue
            self.send("shown", *struct.unpack("<I", payload[:4]))
            if payload[4] == lossless:
                return payload[17:]


OPTIONS = {"lights": 50, "resolution": (320, 200), "samples": 1}


def test_a_page_shows_the_renderers_scene():
    renderer = kilolux.Renderer("plain", **OPTIONS)
    view = kilolux.show(renderer)
    with urllib.request.urlopen(view.address.split("#")[0], timeout=60) as answer:
        assert b"<canvas" in answer.read()
    page = Page(view.address)
    page.send("hello", page.secret, "tab", 320, 200, 1)
    assert page.picture(lossless=True).startswith(b"\x89PNG")
    assert view.address in view._repr_html_()
    assert renderer.render().radiance.shape == (200, 320, 3)  # it goes on beside it
    view.close()
    while True:
        opcode, payload = page.frame()
        if opcode == 8:
            break
    assert struct.unpack(">H", payload[:2]) == (4000,)


def test_one_view_replaces_the_other():
    first = kilolux.show(kilolux.Renderer("plain", **OPTIONS))
    second = kilolux.show(kilolux.Renderer("plain", **OPTIONS))
    assert first.address != second.address
    with pytest.raises(OSError):
        Page(first.address)
    Page(second.address)
    second.close()


def test_scenes_and_lights_from_arrays():
    triangle = kilolux.Mesh(np.array([[0, 0, 0], [4, 0, 0], [0, 4, 0]], np.float32), np.array([[0, 1, 2]]))
    lights = kilolux.Lights(np.array([[1.0, 1.0, 1.0]]), np.array([[1.0, 1.0, 1.0]]), range=5.0)
    view = kilolux.show(kilolux.Renderer(kilolux.Scene([triangle], lights), resolution=(160, 100)))
    page = Page(view.address)
    page.send("hello", page.secret, "tab", 160, 100, 1)
    assert page.picture(lossless=True).startswith(b"\x89PNG")
    view.close()


def test_refusals_are_the_commands():
    renderer = kilolux.Renderer("plain", **OPTIONS)
    with pytest.raises(kilolux.Error, match="'nowhere' is not ADDRESS:PORT"):
        kilolux.show(renderer, serve="nowhere")
    with socket.socket() as taken:
        taken.bind(("127.0.0.1", 0))
        taken.listen()
        with pytest.raises(kilolux.Error, match="cannot listen"):
            kilolux.show(renderer, serve=f"127.0.0.1:{taken.getsockname()[1]}")
    kilolux.show(renderer).close()
