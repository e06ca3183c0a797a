//! The scenes that the program carries, so that `run @cone` needs no checkout: every file of scenes/.

use super::files::Enclosure;

/// A scene that the program carries.
pub struct Carried {
    pub name: &'static str,
    pub text: &'static str,
    /// The files that it names, by the names it has for them.
    files: &'static [(&'static str, &'static [u8])],
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

/// All of them, by name.
pub const CARRIED: &[Carried] = &[
    Carried {
        name: "cone",
        text: include_str!("../../scenes/cone.toml"),
        files: &[],
    },
    Carried {
        name: "cuboids",
        text: include_str!("../../scenes/cuboids.toml"),
        files: &[],
    },
    Carried {
        name: "damped_tumble",
        text: include_str!("../../scenes/damped_tumble.toml"),
        files: &[],
    },
    Carried {
        name: "free_top",
        text: include_str!("../../scenes/free_top.toml"),
        files: &[],
    },
    Carried {
        name: "gyroscope",
        text: include_str!("../../scenes/gyroscope.toml"),
        files: &[],
    },
    Carried {
        name: "heavy_top",
        text: include_str!("../../scenes/heavy_top.toml"),
        files: &[],
    },
    Carried {
        name: "look_alikes",
        text: include_str!("../../scenes/look_alikes.toml"),
        files: &[],
    },
    Carried {
        name: "push_at_a_and_b",
        text: include_str!("../../scenes/push_at_a_and_b.toml"),
        files: &[],
    },
    Carried {
        name: "spheres",
        text: include_str!("../../scenes/spheres.toml"),
        files: &[],
    },
    Carried {
        name: "spin_down",
        text: include_str!("../../scenes/spin_down.toml"),
        files: &[],
    },
    Carried {
        name: "t_handle",
        text: include_str!("../../scenes/t_handle.toml"),
        files: &[("t_handle.obj", include_bytes!("../../scenes/t_handle.obj"))],
    },
    Carried {
        name: "thin_rod",
        text: include_str!("../../scenes/thin_rod.toml"),
        files: &[],
    },
    Carried {
        name: "tops",
        text: include_str!("../../scenes/tops.toml"),
        files: &[],
    },
    Carried {
        name: "wheel",
        text: include_str!("../../scenes/wheel.toml"),
        files: &[],
    },
    Carried {
        name: "wing_nut",
        text: include_str!("../../scenes/wing_nut.toml"),
        files: &[],
    },
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
