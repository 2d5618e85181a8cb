# SPDX-License-Identifier: Apache-2.0
"""kilolux.farm on Dask's workers, one of which dies: the frames are those of one renderer."""
import hashlib
import os
import signal
import time

import distributed
import kilolux
import kilolux.farm

OPTIONS = {"resolution": (64, 36), "lights": 60, "samples": 4}
FRAMES = range(0, 40, 2)


class CountedName(str):
    """A scene's name that counts how often it is pickled; workers get a plain name."""
    pickled = 0

    def __reduce__(self):
        CountedName.pickled += 1
        return str, (str(self),)


def digest(frame, number):
    time.sleep(0.1)  # so that a worker dies in the middle
    return os.getpid(), number, hashlib.sha256(frame.radiance.tobytes()).hexdigest()


def test_frames_of_workers_are_those_of_one_renderer():
    renderer = kilolux.Renderer("grid", **OPTIONS)
    expected = [hashlib.sha256(renderer.render(f / 24.0).radiance.tobytes()).hexdigest() for f in FRAMES]
    with distributed.LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=None) as cluster, \
            distributed.Client(cluster) as client:
        futures = kilolux.farm.map_frames(client, CountedName("grid"), FRAMES, digest, **OPTIONS)
        first = client.gather(futures[0])
        os.kill(first[0], signal.SIGKILL)
        made = client.gather(futures[1:])
    assert 0 < CountedName.pickled < 4, "a scene goes to the cluster once, not with each frame"
    assert [number for _, number, _ in [first, *made]] == list(FRAMES)
    assert [value for _, _, value in [first, *made]] == expected
    assert {process for process, _, _ in made} != {first[0]}, "the worker did not die"
