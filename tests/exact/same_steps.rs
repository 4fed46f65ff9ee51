//! Two small steps by every solver have the bits, bounds and counts that they had: bits are a function of (ordered scene,
//! options, precision) on every target and in every profile, so whatever changes arithmetic shows here, however little.
//!
//! Only digests are compared. Where the arithmetic was *meant* to change, the message is the new table: say so in the commit.

use hooke::{
    BandedLdl, BlockIlu, BlockJacobi, Cables, Portable, Real, Report, Solver, Ssor, Wide, WideJacobi,
};
use hooke_tests::build::{self, Forces};
use hooke_tests::data::{PointData, SceneData};
use hooke_tests::multigrid::multigrid;
use hooke_tests::side_by_side::side_by_side;
use hooke_tests::vec_memory::VecScene;
use hooke_tests::{direct, generate, lanes};

const H: f64 = 1.0 / 60.0;

/// Wrinkled, damped, dragged, held at points, pinned in the middle too; free; tetrahedra; chains; islands.
fn scenes() -> [SceneData; 6] {
    let mut cloth = generate::cloth(7);
    cloth.pinned[24] = true;
    cloth.drag = 0.25;
    for (j, s) in cloth.springs.iter_mut().enumerate() {
        s.c = [0.0, 0.01, 0.02][j % 3];
    }
    for (particle, l0) in [(10, 0.0), (30, 0.125)] {
        cloth.points.push(PointData { particle, target: [0.5, 0.25, 0.5], k: 40.0, l0 });
    }
    let (mut lattice, mut blob, mut chain) =
        (generate::lattice(3, 4, 3), generate::blob(3, 5), generate::chain(150));
    lattice.velocity[5] = [0.5, -0.25, 0.125];
    (blob.pinned[0], blob.pinned[9]) = (true, true);
    for (i, v) in chain.velocity.iter_mut().enumerate().skip(1) {
        *v = [0.1 * (i % 5) as f64, 0.0, 0.2 * (i % 3) as f64];
    }
    let islands = side_by_side(&generate::cloth(6), &generate::chain(40)).0;
    let pressed = {
        let mut cloth = generate::cloth(6);
        cloth.position.iter_mut().for_each(|x| *x = [0.8 * x[0], x[1], 0.9 * x[2]]);
        cloth
    };
    [cloth, lattice, blob, chain, islands, pressed].map(|mut data| {
        let (mut scene, mut forces) = (build::scene::<f64>(&data), Forces::<f64>::new(&data));
        let mut euler = forces.euler(H).tolerance(1e-10);
        (0..4).for_each(|_| assert!(scene.step(&mut euler).is_ok()));
        build::read_back(&scene, &mut data);
        data
    })
}

/// FNV-1a
fn digest(words: impl IntoIterator<Item = u64>) -> u64 {
    let bytes = words.into_iter().flat_map(u64::to_le_bytes);
    bytes.fold(0xcbf2_9ce4_8422_2325, |hash, byte| (hash ^ u64::from(byte)).wrapping_mul(0x100_0000_01b3))
}

fn told<T: Real>(report: &Report<T>) -> Vec<u64> {
    let counts = [report.iterations, report.clamped, report.islands, report.untouched, report.certified];
    let ends = [report.at_floor, report.capped, report.stalled, report.fallbacks];
    let bounds = [report.upper, report.lower].map(|bound| bound.to_f64().to_bits());
    counts.into_iter().chain(ends).map(u64::from).chain(bounds).collect()
}

/// Of each scene two steps, one to the tolerance and one cut short.
fn walk<T: Real, S: Solver<T>>(tolerance: f64, make: impl Fn(&SceneData) -> S) -> Vec<u64> {
    let walk = |data: SceneData| {
        let (mut scene, mut forces) = (build::scene::<T>(&data), Forces::<T>::new(&data));
        let mut solver = make(&data);
        let mut words = Vec::new();
        for most in [10_000, 3] {
            let euler = forces.euler(T::from_f64(H)).tolerance(T::from_f64(tolerance)).max_iterations(most);
            let report = scene.step(&mut euler.solver(&mut solver)).unwrap();
            words.extend(build::bits(&scene).concat());
            words.extend(told(&report));
        }
        digest(words)
    };
    scenes().into_iter().map(walk).collect()
}

/// The digests of both precisions.
fn are<S: Solver<f64>, R: Solver<f32>>(
    expected: [[u64; 6]; 2],
    double: impl Fn(&SceneData) -> S,
    single: impl Fn(&SceneData) -> R,
) {
    let found = [walk::<f64, _>(1e-8, double), walk::<f32, _>(1e-4, single)];
    assert_eq!(found, expected, "\n{found:#x?}");
}

fn ssor<T: Real>(data: &SceneData) -> Ssor<Vec<T>> {
    Ssor::new(vec![T::ONE; Ssor::needs(data.len())])
}

fn ilu<T: Real>(data: &SceneData) -> BlockIlu<Vec<T>> {
    BlockIlu::new(vec![T::ONE; BlockIlu::needs(data.len())])
}

type Lanes<T, P> = Wide<Vec<T>, Vec<u32>, Portable, P>;

fn around<T: Real, P>(data: &SceneData, inner: P) -> Lanes<T, P> {
    let (numbers, words) = WideJacobi::needs_of(&mut build::scene::<T>(data), true);
    WideJacobi::new(vec![T::ONE; numbers], vec![7; words], Portable).around(inner)
}

fn banded_in_lanes<T: Real>(data: &SceneData) -> Lanes<T, BandedLdl<Vec<T>>> {
    let (banded, (numbers, words)) = BandedLdl::needs_in_lanes_of(&mut build::scene::<T>(data), true);
    let banded = BandedLdl::new(vec![T::ONE; banded.max(BandedLdl::needs(data.len(), data.len()))]);
    WideJacobi::new(vec![T::ONE; numbers], vec![7; words], Portable).around(banded)
}

#[test]
fn by_block_jacobi() {
    are(
        [
            [
                0xe74b_b0f1_57c3_7f2e,
                0x0b58_36e5_2dbf_1bdf,
                0x9473_83c5_76aa_1515,
                0x7e05_e82e_9776_384a,
                0xd085_3469_92c4_5c26,
                0x7f8e_d73b_5dd5_6588,
            ],
            [
                0xddde_767e_c5a9_2fc1,
                0x3552_c315_e732_1f27,
                0x8f7e_871d_9c5f_dcb4,
                0x7c88_7be2_3b4a_dae9,
                0x928d_36c9_5d3c_d068,
                0x01d5_4201_860b_0a28,
            ],
        ],
        |_| BlockJacobi,
        |_| BlockJacobi,
    );
}

#[test]
fn by_ssor() {
    are(
        [
            [
                0x6873_d7b3_5382_e669,
                0x7927_eecd_c84d_9a7b,
                0xff74_f840_d5b4_9553,
                0x5b33_5a56_b6f5_3556,
                0x7c48_43ee_8463_0d3e,
                0x2063_e4e4_f067_d19b,
            ],
            [
                0x957d_6ac1_6bfb_010c,
                0xb460_5ce6_97b0_b370,
                0xb38a_4aa1_b062_5936,
                0xaa37_1691_137d_ec78,
                0xdad6_94e7_d655_ba41,
                0x3c04_a458_80c3_c52f,
            ],
        ],
        ssor::<f64>,
        ssor::<f32>,
    );
}

#[test]
fn by_d_ilu() {
    are(
        [
            [
                0x22b3_fcda_3fe4_8502,
                0x8541_b880_4579_66de,
                0x1290_5c91_2ae9_6c3c,
                0x188a_ef8a_3601_a6ed,
                0xbf9d_c935_284b_1b33,
                0xb175_62fa_479c_2cc5,
            ],
            [
                0xe653_cb57_8ca9_2e93,
                0xcfcd_1008_9e85_1f67,
                0xb0aa_c04d_9ca8_0342,
                0xaf98_5682_f5f2_24db,
                0xb020_8736_4846_1259,
                0xedbb_c330_ff8e_6fa4,
            ],
        ],
        ilu::<f64>,
        ilu::<f32>,
    );
}

#[test]
fn by_banded_factors() {
    are(
        [
            [
                0xfbfb_fb4e_cd88_1cff,
                0x715b_c3f3_d174_ab05,
                0xf3d0_51af_b27a_6c35,
                0xcf0c_5be5_291c_b1d1,
                0x34c3_cf5e_6e8b_21a2,
                0x7014_56b2_9fd3_0ff6,
            ],
            [
                0xc461_2b0b_1a24_6d87,
                0x42da_9b02_dcf2_e8b1,
                0xaebf_75ad_49d2_4583,
                0x354a_7fad_e689_c2f8,
                0x46af_893b_b156_b8ca,
                0xf0eb_5c81_477f_2307,
            ],
        ],
        direct::banded::<f64>,
        direct::banded::<f32>,
    );
}

#[test]
fn by_banded_factors_in_lanes() {
    are(
        [
            [
                0xfbfb_fb4e_cd88_1cff,
                0x715b_c3f3_d174_ab05,
                0xf3d0_51af_b27a_6c35,
                0xda66_026b_9048_05a7,
                0x34c3_cf5e_6e8b_21a2,
                0x7014_56b2_9fd3_0ff6,
            ],
            [
                0xc461_2b0b_1a24_6d87,
                0x42da_9b02_dcf2_e8b1,
                0xaebf_75ad_49d2_4583,
                0x6b91_9634_c202_1396,
                0x46af_893b_b156_b8ca,
                0xf0eb_5c81_477f_2307,
            ],
        ],
        banded_in_lanes::<f64>,
        banded_in_lanes::<f32>,
    );
}

#[test]
fn by_sparse_factors() {
    are(
        [
            [
                0x1755_7246_3989_8ec6,
                0x0a82_5c92_de9b_8305,
                0x5231_681d_fbdf_ead8,
                0x36ff_f770_a64a_98b4,
                0x5cd1_46f1_7e85_1d43,
                0xcbe1_2d2c_bd8b_9e2d,
            ],
            [
                0xf749_d66c_f9ef_e14c,
                0x108b_bbdf_e65d_6fff,
                0xd87f_3766_a8bd_36d2,
                0x7803_2ad6_783b_467c,
                0x220e_5582_ff15_8a7f,
                0x2698_9bf4_182c_c508,
            ],
        ],
        direct::sparse::<f64>,
        direct::sparse::<f32>,
    );
}

#[test]
fn by_sparse_factors_in_f32() {
    are(
        [
            [
                0xda01_45d8_2829_b715,
                0x8c3d_92e4_7044_0a8f,
                0x5bf3_f015_87a9_5885,
                0xdb60_1b24_46df_c599,
                0x0052_8a31_7846_d6b3,
                0xd016_7263_9906_8ba0,
            ],
            [
                0x4aa4_bbb9_9b4b_06f3,
                0x9efc_0a81_3254_46ee,
                0xf0e8_9ae7_2492_530c,
                0x62d4_f4ee_efd5_9558,
                0xf8d5_8b8c_1e74_e208,
                0xa28f_c62d_6f3a_280c,
            ],
        ],
        direct::single,
        direct::single,
    );
}

#[test]
fn by_multigrid() {
    are(
        [
            [
                0x9884_ee69_10c1_4b55,
                0x4726_d692_34b7_2185,
                0x6f2a_842d_7af5_6f43,
                0x0287_12af_57ce_178f,
                0xaed9_7bce_0808_ab6a,
                0x6b1c_bc67_dde7_0f85,
            ],
            [
                0x8605_3844_96e6_2835,
                0x0ad8_821a_5acc_17ee,
                0x5137_743c_9413_aa56,
                0x952b_030b_2cdb_9915,
                0xc372_4630_c366_a193,
                0x2a4f_397f_f87c_02fb,
            ],
        ],
        multigrid,
        multigrid,
    );
}

#[test]
fn by_block_jacobi_in_lanes() {
    are(
        [
            [
                0x4549_22a9_3310_2881,
                0x0b58_36e5_2dbf_1bdf,
                0x9473_83c5_76aa_1515,
                0xc0b9_9c95_68c1_a9da,
                0xd125_026f_ae0f_59a4,
                0x5fc0_e0ef_5071_8601,
            ],
            [
                0x50bc_debb_875e_4281,
                0x3552_c315_e732_1f27,
                0x8f7e_871d_9c5f_dcb4,
                0xd7d5_a520_9179_5ce7,
                0x0357_0c3b_518e_9d84,
                0xcf37_3a7c_1b02_e191,
            ],
        ],
        lanes::wide::<f64>,
        lanes::wide::<f32>,
    );
}

#[test]
fn by_block_jacobi_in_single() {
    are(
        [
            [
                0x8956_a62c_7e95_17aa,
                0x0b58_36e5_2dbf_1bdf,
                0x9473_83c5_76aa_1515,
                0x0b60_2589_ba9c_6697,
                0x7544_4216_d310_fb0d,
                0x2f04_653e_1de8_652d,
            ],
            [
                0x6e00_9b55_71cc_c08a,
                0x3552_c315_e732_1f27,
                0x8f7e_871d_9c5f_dcb4,
                0x56fc_be81_c9bd_f223,
                0xd67e_7f0b_4a34_843c,
                0x6f41_24e5_7da2_d441,
            ],
        ],
        lanes::single::<f64>,
        lanes::single::<f32>,
    );
}

#[test]
fn by_multigrid_in_lanes() {
    are(
        [
            [
                0xec68_7bda_1306_46ef,
                0x4726_d692_34b7_2185,
                0x6f2a_842d_7af5_6f43,
                0x3630_cefe_eebb_b44f,
                0x40cd_7f90_ac26_ef35,
                0x229c_43dd_eb9e_ea8f,
            ],
            [
                0x4298_bd87_7b6c_72c8,
                0x0ad8_821a_5acc_17ee,
                0x5137_743c_9413_aa56,
                0xacff_56a5_ba44_2827,
                0x96f9_5034_4433_17fe,
                0x6095_647f_2398_a718,
            ],
        ],
        |data| around::<f64, _>(data, multigrid(data)),
        |data| around::<f32, _>(data, multigrid(data)),
    );
}

#[test]
fn cables_in_lanes_are_clamped_as_by_the_plain_solver_and_end_where_it_ends() {
    for data in scenes() {
        let mut scenes = [VecScene::<f64, Cables>::empty(), VecScene::empty()];
        for scene in &mut scenes {
            build::fill(scene, &data).unwrap();
        }
        let (numbers, words) = WideJacobi::needs_of(&mut scenes[0], true);
        let mut forces = Forces::<f64>::new(&data);
        let wide = WideJacobi::new(vec![1.0; numbers], vec![7; words], Portable);
        let [a, b] = &mut scenes;
        let one = a.step(&mut forces.euler(H).tolerance(1e-12).solver(wide)).unwrap();
        let other = b.step(&mut forces.euler(H).tolerance(1e-12)).unwrap();
        assert_eq!((one.clamped, one.certified), (other.clamped, other.certified));
        let off = build::farthest(&build::positions(a), &build::positions(b));
        assert!(off <= 1e-9, "{off:e}");
    }
}
