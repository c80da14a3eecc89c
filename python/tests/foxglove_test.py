"""A run in Foxglove: a client of its websocket, as Foxglove is one."""

import asyncio
import json
import os
import subprocess
import threading

import pytest
from tornado.websocket import websocket_connect

import prowl

DURATION = 2.5  # [s]
TWIST = {"linear": {"x": 0.3, "y": 0.0, "z": 0.0}, "angular": {"x": 0.0, "y": 0.0, "z": 0.0}}


async def listen(url, seen):
    """Subscribes to all topics, sends a command, and keeps the last message of each topic and their number."""
    socket = await websocket_connect(url, subprotocols=["foxglove.sdk.v1"])
    topics = {}
    while (message := await socket.read_message()) is not None:
        if isinstance(message, bytes):
            if message[0] == 1:  # data of a subscription, after its number and the time
                seen.setdefault(topics[int.from_bytes(message[1:5], "little")], []).append(message[13:])
            continue
        said = json.loads(message)
        if said["op"] != "advertise":
            continue
        wanted = [{"id": channel["id"], "channelId": channel["id"]} for channel in said["channels"]]
        topics |= {channel["id"]: channel["topic"] for channel in said["channels"]}
        await socket.write_message(json.dumps({"op": "subscribe", "subscriptions": wanted}))
        if len(topics) == len(wanted):
            mine = {"id": 1, "topic": "/cmd_vel", "encoding": "json", "schemaName": "geometry_msgs/Twist"}
            await socket.write_message(json.dumps({"op": "advertise", "channels": [mine]}))
            for text in ("no JSON", "{}", json.dumps(TWIST)):
                await socket.write_message(b"\x01" + (1).to_bytes(4, "little") + text.encode(), binary=True)


def test_a_client_sees_and_commands_the_robot():
    hyq, seen = prowl.read_robot("hyq"), {}
    with prowl.Foxglove(hyq, port=0) as server:
        client = threading.Thread(target=lambda: asyncio.run(listen(server.url, seen)), daemon=True)
        client.start()
        run = prowl.run_online(hyq, duration=DURATION, watch=server)
    client.join(timeout=10.0)
    assert run.success and run.commanded[-1, 0] == pytest.approx(0.3)
    assert len(seen["/robot_description"]) >= 1 and b"<robot" in seen["/robot_description"][0]
    assert {"/tf", "/tf_static", "/joint_states", "/odom", "/contacts/lf_foot"} <= set(seen)
    assert 30 < len(seen["/joint_states"]) <= 30 * DURATION + 2


def test_a_port_that_is_taken():
    hyq = prowl.read_robot("hyq")
    with prowl.Foxglove(hyq, port=0) as server:
        port = int(server.url.rpartition(":")[2])
        with pytest.raises(prowl.InputError, match=f"port {port}"):
            prowl.Foxglove(hyq, port=port)


def test_the_command_serves_it():
    command = [os.environ["PROWL_COMMAND"], "mpc", "hyq", "--duration", "1", "--command", "0.1", "0", "0"]
    run = subprocess.run([*command, "--foxglove", "--port", "0", "--json"], capture_output=True, text=True)
    assert run.returncode == 0 and "ws://127.0.0.1:" in run.stderr, run.stderr
    assert json.loads(run.stdout)["end_time_s"] == pytest.approx(1.0)
    refused = subprocess.run([*command, "--port", "8000"], capture_output=True, text=True)
    assert refused.returncode == 2 and "--port needs --view or --foxglove" in refused.stderr
