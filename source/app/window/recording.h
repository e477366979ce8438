#pragma once
// What a run in the window does while it is recorded: a film of its picture and its series.
#include "app/film.h"
#include "app/recorder.h"
#include "measure/probes.h"
#include "measure/series_files.h"
#include "measure/validity.h"
#include "scene/scene.h"

#include <algorithm>
#include <string>
#include <vector>

namespace spindrift {

// Both follow the run's time: a film that is shown at its rate plays the run at view.speed times
// real time, however fast or slowly it was computed. A run that goes back to an earlier time takes
// its rows with it; what is in the film stays.
class Recording {
public:
    // Pictures of this size into "<scene>-001.mp4" of a folder and rows into "<scene>-001.csv", or
    // the first number that both names have free. Throws Error (Output), which says how to get
    // ffmpeg where there is none.
    Recording(const Scene&, double time, int width, int height, const std::string& folder = ".");

    // Where the run stands now, and what of it is outside its validity. Adds a row when one is due.
    // The formulation, and with it the columns, must be the one that it began with.
    void follow(Simulation&, const Measurement&, const std::vector<Remark>&);
    // Whether a picture of where it stands is due; as many copies of it are added as that is late.
    bool wantsPicture() const { return isReached(nextPicture_, now_); }
    void add(const Image&, double speed);
    // s: the run is wanted there.
    double next() const { return std::min(nextPicture_, nextRow_); }
    int width() const { return width_; }
    int height() const { return height_; }

    // Both files are whole then. Throws Error (Output).
    void finish();
    const std::string& film() const { return film_; }
    const std::string& series() const { return series_; }
    double seconds() const { return double(pictures_) / rate_; }  // of film

private:
    std::string film_, series_;  // paths
    Probes probes_;
    SeriesFiles rows_;
    double rate_, rowEvery_;              // pictures a second; s simulated
    double now_, nextPicture_, nextRow_;  // s simulated
    int width_, height_;
    size_t pictures_ = 0;
    Film pictureFile_;
};

// What files of a scene are called: its name, as file names can be.
std::string fileStem(const std::string& sceneName);

}  // namespace spindrift
