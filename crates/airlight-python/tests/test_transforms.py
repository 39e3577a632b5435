"""Fog in the pipelines of training: albumentations, torchvision, data loaders."""

import pickle

import numpy as np
import pytest

import airlight
from airlight.transforms import Fog, FogRange


def test_draws_fill_the_range_evenly_in_the_logarithm():
    visibilities = FogRange((50, 500))
    assert visibilities.draw(0.0) == 50
    assert visibilities.draw(1.0) == 500
    assert visibilities.draw(0.5) == pytest.approx(50 * 10**0.5)
    assert FogRange(80).draw(0.7) == 80


def test_transform_is_the_fog_of_its_visibility(photograph, depth):
    foggy, same = Fog(visibility_m=120, fov_deg=70)(photograph, depth)
    np.testing.assert_array_equal(foggy, airlight.Fog(120, fov_deg=70)(photograph, depth))
    assert same is depth
    sample = Fog(visibility_m=120, fov_deg=70)({"image": photograph, "depth": depth, "label": 3})
    np.testing.assert_array_equal(sample["image"], foggy)
    assert sample["label"] == 3


def test_a_seed_gives_the_same_sequence_also_after_pickling(photograph, depth):
    transform = Fog(seed=3)
    again = pickle.loads(pickle.dumps(transform))
    first = [transform(photograph, depth)[0] for _ in range(3)]
    for picture in first:
        np.testing.assert_array_equal(again(photograph, depth)[0], picture)
    assert (first[0] != first[1]).any()
    assert (Fog(seed=4)(photograph, depth)[0] != first[0]).any()


def test_probability_is_that_of_fog(photograph, depth):
    transform = Fog(p=0.3, seed=1)
    foggy = sum(transform(photograph, depth)[0] is not photograph for _ in range(400))
    assert 80 < foggy < 160


def test_encoded_floats_agree_with_bytes(photograph, depth):
    transform = Fog(visibility_m=150, ambient=(0.5, 0.5, 0.5))
    floats = transform(photograph.astype(np.float32) / 255, depth)[0]
    assert floats.dtype == np.float32
    assert np.abs(255 * floats - transform(photograph, depth)[0]).max() < 1.1


@pytest.mark.parametrize(
    "settings", [{"visibility_m": (500, 50)}, {"visibility_m": -1}, {"p": 2}, {"profile": "thick"}, {"visibility_m": (0, 50)}]
)
def test_bad_settings_are_refused_at_once(settings):
    with pytest.raises(ValueError, match="expected"):
        Fog(**settings)


def test_pictures_without_depth_are_refused(photograph):
    for sample in (photograph, {"image": photograph}):
        with pytest.raises(ValueError, match="depth"):
            Fog()(sample)


class TestAlbumentations:
    """The transform in pipelines of albumentations."""

    @pytest.fixture
    def albumentations(self):
        return pytest.importorskip("albumentations")

    def pipeline(self, albumentations, *more, seed=1):
        from airlight.transforms.albumentations import Fog as Transform

        fog = Transform(visibility_m=(50, 500), p=1.0)
        return albumentations.Compose([*more, fog], additional_targets={"depth": "mask"}, seed=seed)

    def test_a_seed_determines_the_pictures(self, albumentations, photograph, depth):
        first, again, other = (self.pipeline(albumentations, seed=seed) for seed in (1, 1, 2))
        pictures = [first(image=photograph, depth=depth)["image"] for _ in range(3)]
        for picture in pictures:
            np.testing.assert_array_equal(again(image=photograph, depth=depth)["image"], picture)
        assert (pictures[0] != pictures[1]).any()
        assert (other(image=photograph, depth=depth)["image"] != pictures[0]).any()

    def test_depth_follows_crops_and_flips(self, albumentations, photograph, depth):
        near = depth.copy()
        near[:, :32] = 1.0
        flip = albumentations.HorizontalFlip(p=1.0)
        out = self.pipeline(albumentations, flip)(image=photograph, depth=near)
        np.testing.assert_array_equal(out["depth"], near[:, ::-1])
        changed = np.abs(out["image"].astype(int) - photograph[:, ::-1]).mean(axis=(0, 2))
        assert changed[32:].mean() < 0.2 * changed[:32].mean()

    def test_pipelines_are_pickled_and_serialized(self, albumentations, photograph, depth):
        pipeline = self.pipeline(albumentations)
        again = pickle.loads(pickle.dumps(pipeline))
        serialized = albumentations.from_dict(albumentations.to_dict(pipeline))
        serialized.set_random_seed(1)
        picture = pipeline(image=photograph, depth=depth)["image"]
        for other in (again, serialized):
            np.testing.assert_array_equal(other(image=photograph, depth=depth)["image"], picture)


class _Pictures:
    """A data set of one picture."""

    def __init__(self, transform, photograph, depth):
        self.transform, self.sample = transform, (photograph, depth)

    def __len__(self):
        return 8

    def __getitem__(self, index):
        return self.transform(*self.sample)[0]


@pytest.mark.slow
class TestTorch:
    """The transform on tensors, in torchvision and in data loaders."""

    @pytest.fixture
    def torch(self):
        return pytest.importorskip("torch")

    def test_tensors_are_foggy_like_arrays(self, torch, photograph, depth):
        transform = Fog(visibility_m=100)
        tensor = torch.from_numpy(np.moveaxis(photograph, -1, 0).copy())
        foggy, _ = transform(tensor, torch.from_numpy(depth)[None])
        np.testing.assert_array_equal(np.moveaxis(foggy.numpy(), 0, -1), transform(photograph, depth)[0])

    def test_torchvision_composes_it(self, torch, photograph, depth):
        v2 = pytest.importorskip("torchvision.transforms.v2")
        from torchvision import tv_tensors

        pipeline = v2.Compose([v2.RandomHorizontalFlip(p=1.0), Fog(visibility_m=100)])
        image = tv_tensors.Image(np.moveaxis(photograph, -1, 0).copy())
        foggy, flipped = pipeline(image, tv_tensors.Mask(depth[None]))
        assert isinstance(foggy, tv_tensors.Image)
        expected = Fog(visibility_m=100)(photograph[:, ::-1], depth[:, ::-1])[0]
        np.testing.assert_array_equal(np.moveaxis(foggy.numpy(), 0, -1), expected)
        assert flipped.shape == (1, 48, 64)

    @pytest.mark.parametrize("method", ["fork", "spawn"])
    @pytest.mark.parametrize("seed", [None, 5])
    def test_workers_draw_different_fog_that_a_seed_repeats(self, torch, method, seed, photograph, depth):
        pictures = []
        for _ in range(2):
            torch.manual_seed(1)
            data = _Pictures(Fog(seed=seed), photograph, depth)
            loader = torch.utils.data.DataLoader(data, batch_size=1, num_workers=2, multiprocessing_context=method)
            pictures.append(np.stack([batch[0].numpy() for batch in loader]))
        np.testing.assert_array_equal(pictures[0], pictures[1])
        assert len({picture.tobytes() for picture in pictures[0]}) == 8
