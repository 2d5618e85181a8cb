# SPDX-License-Identifier: Apache-2.0
"""Metrics on arrays against their definitions, and against the program's."""
import json

import kilolux
import numpy as np
import pytest
from conftest import SMALL, SMALL_WORDS, run

RANDOM = np.random.default_rng(11)
LIGHT = RANDOM.uniform(0, 4, (24, 32, 3)).astype(np.float32)
CODES = RANDOM.integers(0, 256, (24, 32, 3), dtype=np.uint8)


def test_definitions():
    other = LIGHT + np.float32(0.25)
    error = other.astype(np.float64) - LIGHT
    assert kilolux.rmse(other, LIGHT) == pytest.approx(np.sqrt((error**2).mean()), rel=1e-12)
    assert kilolux.max_error(other, LIGHT) == pytest.approx(np.abs(error).max(), rel=1e-12)
    assert kilolux.psnr(other, LIGHT) == pytest.approx(20 * np.log10(LIGHT.max() / np.sqrt((error**2).mean())))
    assert kilolux.psnr(other, LIGHT, peak=1.0) == pytest.approx(-10 * np.log10((error**2).mean()))
    r = LIGHT.astype(np.float64)
    assert kilolux.relmse(other, LIGHT) == pytest.approx((error**2 / (r**2 + 1e-2 * r.mean() ** 2)).mean())


def test_codes_count_from_0_to_1_and_alpha_does_not():
    other = CODES ^ 8
    difference = (other.astype(float) - CODES) / 255
    assert kilolux.rmse(other, CODES) == pytest.approx(np.sqrt((difference**2).mean()))
    assert kilolux.psnr(other, CODES) == pytest.approx(-10 * np.log10((difference**2).mean()))
    with_alpha = np.dstack([other, RANDOM.integers(0, 256, (24, 32), dtype=np.uint8)])
    for metric in (kilolux.rmse, kilolux.flip, kilolux.ssim):
        assert metric(with_alpha, CODES) == metric(other, CODES)
    assert 0 < kilolux.ssim(other, CODES) < 1 == kilolux.ssim(CODES, CODES)


def test_equal_pictures():
    for picture in (LIGHT, CODES):
        assert kilolux.rmse(picture, picture) == 0 == kilolux.flip(picture, picture)
        assert kilolux.psnr(picture, picture) == np.inf
    assert kilolux.ssim(CODES[:8], CODES[:8]) is None


def test_flip_is_that_of_the_program(tmp_path):
    darker = {"ambient": 0.3}
    for extension, kind in ((".exr", "radiance"), (".png", "display")):
        reference = tmp_path / f"r{extension}"
        assert run("render", "grid", *SMALL_WORDS, "-o", reference).returncode == 0
        result = run("render", "grid", *SMALL_WORDS, "--ambient", "0.3", "--reference", reference, "--metric", "flip",
                     "--threshold", "9", "--stats", "-", "-o", tmp_path / f"a{extension}")
        errors = json.loads(result.stdout)["error"]["errors"]
        picture = getattr(kilolux.render("grid", **darker, **SMALL), kind)
        before = getattr(kilolux.render("grid", **SMALL), kind)
        # The program has a file's codes in float32.
        assert kilolux.flip(picture, before) == pytest.approx(errors["flip"], rel=1e-6)
        assert kilolux.rmse(picture, before) == pytest.approx(errors["rmse"], rel=1e-6)
        assert kilolux.flip_map(picture, before).mean() == pytest.approx(errors["flip"], rel=1e-6)


def test_bad_pictures_are_refused():
    with pytest.raises(kilolux.Error, match=r"picture: shape \(24, 32\), must be \(height, width, 3\)"):
        kilolux.rmse(LIGHT[..., 0], LIGHT)
    with pytest.raises(kilolux.Error, match="24"):
        kilolux.rmse(LIGHT, LIGHT[:, :8])
    with pytest.raises(kilolux.Error, match="must be uint8"):
        kilolux.ssim(LIGHT, LIGHT)
    with pytest.raises(kilolux.Error, match="one picture has sRGB codes"):
        kilolux.flip(LIGHT, CODES)
    with pytest.raises(kilolux.Error, match="values are uint16, must be uint8"):
        kilolux.rmse(CODES.astype(np.uint16), CODES.astype(np.uint16))


def test_ssim_is_scikit_images():
    metrics = pytest.importorskip("skimage.metrics", reason="package python3-skimage")
    luma = np.array([0.2126, 0.7152, 0.0722])
    y, x = np.mgrid[0:40, 0:56]
    waves = np.stack([128 + 100 * np.sin(0.2 * x + k) * np.cos(0.3 * y) for k in range(3)], axis=-1).astype(np.uint8)
    for picture, reference in ((CODES ^ 8, CODES), (np.roll(waves, 1, axis=1), waves), (waves // 2, waves)):
        # Wang et al. 2004: a Gaussian window of 11 pixels, and no windows over the border.
        _, windows = metrics.structural_similarity(picture @ luma, reference @ luma, gaussian_weights=True, sigma=1.5,
                                                   use_sample_covariance=False, data_range=255, full=True)
        assert kilolux.ssim(picture, reference) == pytest.approx(windows[5:-5, 5:-5].mean(), abs=1e-6)
