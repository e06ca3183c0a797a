//! The scenes that the program carries, so that `run @cone` needs no checkout: every file of scenes/.

use super::files::Enclosure;

/// A scene that the program carries.
pub struct Carried {
    pub name: &'static str,
    pub text: &'static str,
    /// The files that it names, by the names it has for them.
    files: &'static [File],
}

impl Carried {
    /// The files that it names.
    pub fn enclosures(&self) -> Vec<Enclosure> {
        let files = self.files.iter();
        files
            .map(|(name, bytes)| Enclosure::new(name, bytes.to_vec()))
            .collect()
    }
}

/// One by its name.
pub fn find(name: &str) -> Option<&'static Carried> {
    CARRIED.iter().find(|scene| scene.name == name)
}

type File = (&'static str, &'static [u8]);

const fn carried(name: &'static str, text: &'static str, files: &'static [File]) -> Carried {
    Carried { name, text, files }
}

const T_HANDLE: File = ("t_handle.obj", include_bytes!("../../scenes/t_handle.obj"));

/// All of them, by name.
#[rustfmt::skip]
pub const CARRIED: &[Carried] = &[
    carried("click_storm", include_str!("../../scenes/click_storm.toml"), &[]),
    carried("cone", include_str!("../../scenes/cone.toml"), &[]),
    carried("cuboids", include_str!("../../scenes/cuboids.toml"), &[]),
    carried("damped_tumble", include_str!("../../scenes/damped_tumble.toml"), &[]),
    carried("detumble", include_str!("../../scenes/detumble.toml"), &[]),
    carried("five_engines", include_str!("../../scenes/five_engines.toml"), &[]),
    carried("free_top", include_str!("../../scenes/free_top.toml"), &[]),
    carried("gyroscope", include_str!("../../scenes/gyroscope.toml"), &[]),
    carried("heavy_top", include_str!("../../scenes/heavy_top.toml"), &[]),
    carried("look_alikes", include_str!("../../scenes/look_alikes.toml"), &[]),
    carried("push_at_a_and_b", include_str!("../../scenes/push_at_a_and_b.toml"), &[]),
    carried("satellite", include_str!("../../scenes/satellite.toml"), &[]),
    carried("spheres", include_str!("../../scenes/spheres.toml"), &[]),
    carried("spin_down", include_str!("../../scenes/spin_down.toml"), &[]),
    carried("swarm", include_str!("../../scenes/swarm.toml"), &[]),
    carried("t_handle", include_str!("../../scenes/t_handle.toml"), &[T_HANDLE]),
    carried("thin_rod", include_str!("../../scenes/thin_rod.toml"), &[]),
    carried("tops", include_str!("../../scenes/tops.toml"), &[]),
    carried("wheel", include_str!("../../scenes/wheel.toml"), &[]),
    carried("wing_nut", include_str!("../../scenes/wing_nut.toml"), &[]),
];

#[cfg(test)]
mod tests {
    use super::*;
    use std::path::Path;

    #[test]
    fn every_scene_of_the_folder_is_carried() {
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes");
        let mut names: Vec<String> = std::fs::read_dir(folder)
            .unwrap()
            .map(|entry| entry.unwrap().file_name().into_string().unwrap())
            .filter_map(|name| name.strip_suffix(".toml").map(str::to_owned))
            .collect();
        names.sort();
        let carried: Vec<&str> = CARRIED.iter().map(|scene| scene.name).collect();
        assert_eq!(
            carried, names,
            "add the scene to CARRIED, in order of the names"
        );
    }

    #[test]
    fn they_are_right_and_bring_the_files_that_they_name() {
        for scene in CARRIED {
            let path = format!("@{}", scene.name);
            let script = crate::scene::Script::load(Path::new(&path)).unwrap();
            let read = script.scene().unwrap_or_else(|why| panic!("{why}"));
            assert_eq!(read.enclosures, scene.enclosures(), "{path}");
        }
    }
}
